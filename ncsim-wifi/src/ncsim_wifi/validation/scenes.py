"""The arrangements of links and transfers that the experiments are about."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from ncsim_core.network import Link, LinkId, Network, Node, NodeId, Position

from ncsim_wifi.radio import Radio

LENGTH_m = 30.0
LARGE_MB = 1000.0  # makes rounding to microseconds invisible in an average rate


@dataclass(frozen=True)
class Flow:
    """One transfer over one link.

    Args:
        link: Number of the link in its scene.
        size_MB: Payload.
        start_s: When it starts.
    """

    link: int
    size_MB: float = LARGE_MB
    start_s: float = 0.0


@dataclass(frozen=True)
class Scene:
    """Links in the plane and what they carry.

    Args:
        senders_m: Where each link begins.
        receivers_m: Where it ends.
        flows: What it carries.
        radio: What all radios have in common.
    """

    senders_m: tuple[tuple[float, float], ...]
    receivers_m: tuple[tuple[float, float], ...]
    flows: tuple[Flow, ...]
    radio: Radio = field(default_factory=Radio)

    def network(self) -> Network:
        """Return the links as a network; ends at the same place are the same node."""
        places = list(dict.fromkeys((*self.senders_m, *self.receivers_m)))
        nodes = {at: Node(NodeId(f"n{i}"), 1.0, Position(*at)) for i, at in enumerate(places)}
        ends = zip(self.senders_m, self.receivers_m, strict=True)
        links = tuple(
            Link(LinkId(f"l{i}"), nodes[a].id, nodes[b].id) for i, (a, b) in enumerate(ends)
        )
        return Network(tuple(nodes.values()), links)


def single(distance_m: float, radio: Radio = Radio()) -> Scene:  # noqa: B008 - frozen
    """Return one link of a given length with one transfer."""
    return Scene(((0.0, 0.0),), ((distance_m, 0.0),), (Flow(0),), radio)


def parallel(
    count: int,
    separation_m: float,
    flows: Sequence[Flow] | None = None,
    radio: Radio = Radio(),  # noqa: B008 - frozen
    length_m: float = LENGTH_m,
) -> Scene:
    """Return parallel links; by default each carries one transfer of the same size."""
    rows_m = [separation_m * i for i in range(count)]
    return Scene(
        tuple((0.0, y_m) for y_m in rows_m),
        tuple((length_m, y_m) for y_m in rows_m),
        tuple(flows) if flows is not None else tuple(Flow(i) for i in range(count)),
        radio,
    )
