"""Stage 3 for ``csma_spatial``: its goodputs against packets, family by family."""

import json
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from ncsim_wifi.phy.mcs import read_table
from ncsim_wifi.phy.path_loss import distances_m
from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.plant import Plant
from ncsim_wifi.spatial.saturated import saturated_goodputs_MBps
from ncsim_wifi.spatial.settings import Settings, Terms
from ncsim_wifi.spatial.transfers import Paths
from ncsim_wifi.validation.rows import Row

DATA = Path(__file__).parent / "packet_data"
TX_POWER_dBm, REFERENCE_LOSS_dB, NOISE_dBm = 20.0, 46.4, -94.97  # SOURCE.md
LEAST_GOODPUT_MBps = 0.01  # starved links count relative to this
ACCEPTED_ERROR = {
    "separation": 0.02,
    "contention": 0.06,
    "three_links": 0.06,
    "four_five_links": 0.09,
    "chain": 0.05,
    "relays": 0.15,
    "shared_radio": 0.05,
    "rts_cts": 0.06,
    "random_dev": 0.12,
    "random_new": 0.12,
    "random_unseen": 0.12,
    "random_fresh": 0.12,
    "rts_unseen": 0.20,
    "crowds": 0.30,
}
"""Weighted absolute percentage error of each family."""
ACCEPTED_MEDIAN = {
    "random_dev": 0.12,
    "random_new": 0.12,
    "random_unseen": 0.12,
    "random_fresh": 0.12,
}


class PacketRow(NamedTuple):
    """One link, or one relayed transfer, in packets and in the model."""

    family: str
    case: str
    link: str
    expected_MBps: float
    predicted_MBps: float

    @property
    def error_MBps(self) -> float:
        """Return by how much the model is off."""
        return abs(self.predicted_MBps - self.expected_MBps)

    @property
    def relative_error(self) -> float:
        """Return the error relative to packets; starved links count relative to 0.01 MB/s."""
        return self.error_MBps / max(self.expected_MBps, LEAST_GOODPUT_MBps)


def rows() -> Iterator[Row]:
    """Yield all comparisons by family, each with its errors against what is accepted."""
    compared = default_rows()
    errors = error_by_family(compared)
    for family, (weighted, middle) in errors.items():
        yield from (_told(row) for row in compared if row.family == family)
        if family in ACCEPTED_ERROR:
            yield _judged(family, "weighted", ACCEPTED_ERROR[family], weighted)
        if family in ACCEPTED_MEDIAN:
            yield _judged(family, "median", ACCEPTED_MEDIAN[family], middle)


def _told(row: PacketRow) -> Row:
    name, quantity = f"csma_spatial, {row.family}", f"MB/s of {row.link}"
    numbers = row.expected_MBps, "ns-3", row.predicted_MBps
    return Row("packet", name, row.case, quantity, *numbers, None, is_detail=True)


def _judged(family: str, kind: str, accepted: float, measured: float) -> Row:
    name, quantity = f"csma_spatial, {family}", f"{kind} relative error"
    return Row("packet", name, "all", quantity, accepted, "ns-3", measured, 0.0, "<=")


@cache
def default_rows() -> tuple[PacketRow, ...]:
    """Return all comparisons of the plug-in as it comes, worked out once per process."""
    return tuple(packet_rows())


def packet_rows(terms: Terms | None = None) -> Iterator[PacketRow]:
    """Yield all comparisons; chains whose hops are all backlogged are family ``backlog``.

    Args:
        terms: Which effects count, for ablations; the default is that of the plug-in.
    """
    for family in ACCEPTED_ERROR:
        for case in json.loads((DATA / f"{family}.json").read_text("utf-8"))["cases"]:
            rows = _relayed if "flows" in case else _saturated
            yield from rows(family, case, terms or Terms())


def error_by_family(rows: Sequence[PacketRow]) -> Mapping[str, tuple[float, float]]:
    """Return weighted absolute percentage error and median relative error of each family."""
    families: dict[str, list[PacketRow]] = {}
    for row in rows:
        families.setdefault(row.family, []).append(row)
    return {
        family: (
            sum(row.error_MBps for row in members) / sum(row.expected_MBps for row in members),
            median(row.relative_error for row in members),
        )
        for family, members in families.items()
    }


def _saturated(family: str, case: Mapping[str, Any], terms: Terms) -> Iterator[PacketRow]:
    ends = [(link["from"], link["to"]) for link in case["links"]]
    ids = [link["id"] for link in case["links"]]
    plant = _plant(case, ids, ends, [link["mcs"] for link in case["links"]], terms)
    goodputs_MBps: FloatArray = saturated_goodputs_MBps(plant, range(len(ids)))
    name = "backlog" if family == "chain" else family
    for link, goodput_MBps in zip(ids, goodputs_MBps.tolist(), strict=True):
        yield PacketRow(name, case["id"], link, case["goodput_MBps"][link], goodput_MBps)


def _relayed(family: str, case: Mapping[str, Any], terms: Terms) -> Iterator[PacketRow]:
    scheme_of = {
        hop: flow["mcs"]
        for flow in case["flows"]
        for hop in zip(flow["path"], flow["path"][1:], strict=False)
    }
    ends = list(scheme_of)
    plant = _plant(case, ["-".join(hop) for hop in ends], ends, list(scheme_of.values()), terms)
    paths = Paths(plant, range(len(ends)), plant.solo_MBps.tolist())
    routes = [
        tuple(ends.index(hop) for hop in zip(flow["path"], flow["path"][1:], strict=False))
        for flow in case["flows"]
    ]
    rates_MBps = paths.rates(tuple(sorted(routes)))
    for flow, route in zip(case["flows"], routes, strict=True):
        expected_MBps = case["flow_goodput_MBps"][flow["id"]]
        yield PacketRow(family, case["id"], flow["id"], expected_MBps, rates_MBps[route][0])


def _plant(
    case: Mapping[str, Any],
    ids: Sequence[str],
    ends: Sequence[tuple[str, str]],
    schemes: Sequence[int],
    terms: Terms,
) -> Plant:
    index = {node["id"]: at for at, node in enumerate(case["nodes"])}
    apart_m = distances_m(np.array([[node["x"], node["y"]] for node in case["nodes"]], np.float64))
    loss_dB = REFERENCE_LOSS_dB + 30.0 * np.log10(np.maximum(apart_m, 1.0))
    rates_Mbps = read_table("ax").rate_Mbps
    return Plant(
        tuple(ids),
        np.array([index[source] for source, _ in ends]),
        np.array([index[target] for _, target in ends]),
        np.array(schemes),
        np.array([rates_Mbps[scheme] for scheme in schemes]),
        TX_POWER_dBm - loss_dB,
        Settings(noise_dBm=NOISE_dBm, rts_cts=case["rts_cts"], terms=terms),
    )
