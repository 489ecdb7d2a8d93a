"""Both radio models against ns-3: weighted and median error in every family of packet scenes.

    python examples/spatial/packets.py

Every link always has something to send; ``csma_bianchi`` is asked as the engine asks it, with the
stated schemes as rates. Scenes with relayed transfers are left out, for which it has no answer.
"""

import json
import sys
from collections.abc import Iterator

from ncsim_core.network import Link, Network, Node, Position
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.making import make_scenario
from ncsim_core.workflow import DAG, Task
from ncsim_wifi.phy.mcs import read_table
from ncsim_wifi.validation.spatial_packets import (
    ACCEPTED_ERROR,
    DATA,
    PacketRow,
    default_rows,
    error_by_family,
)

MBPS_PER_Mbps = 1 / 8


def bianchi_rows() -> Iterator[PacketRow]:
    """Yield every saturated link, in packets and under ``csma_bianchi``."""
    rates_Mbps = read_table("ax").rate_Mbps
    for family in ACCEPTED_ERROR:
        for case in json.loads((DATA / f"{family}.json").read_text("utf-8"))["cases"]:
            if "flows" in case:
                continue
            nodes = [Node(n["id"], 1.0, Position(n["x"], n["y"])) for n in case["nodes"]]
            links = [
                Link(link["id"], link["from"], link["to"], rates_Mbps[link["mcs"]] * MBPS_PER_Mbps)
                for link in case["links"]
            ]
            config = {
                "scheduler": "round_robin", "routing": "minimum_hop",
                "link_model": {"type": "wifi", "options": {"rate": "solo"}},
                "interference": "csma_bianchi",
                "rf": {"path_loss_exponent": 3.0, "rts_cts": case["rts_cts"]},
            }  # fmt: skip
            nothing = DAG("none", (Task("t", 1.0),), ())
            network = Network(tuple(nodes), tuple(links))
            run = assemble(make_scenario(case["id"], network, [nothing], config))
            factors = run.models.interference.factors(range(len(links)), range(len(links)))
            name = "backlog" if family == "chain" else family
            for link, factor, clean_MBps in zip(
                links, factors.tolist(), run.network.bandwidth_MBps, strict=True
            ):
                packets_MBps = case["goodput_MBps"][link.id]
                yield PacketRow(name, case["id"], link.id, packets_MBps, factor * clean_MBps)


def main() -> None:
    """Print the table."""
    bianchi = error_by_family(list(bianchi_rows()))
    spatial = error_by_family(default_rows())
    lines = [f"{'weighted, median error':24} {'csma_bianchi':>16} {'csma_spatial':>16}"]
    for family, (weighted, middle) in bianchi.items():
        other = spatial[family]
        lines.append(f"{family:24} {weighted:9.1%} {middle:6.1%} {other[0]:9.1%} {other[1]:6.1%}")
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
