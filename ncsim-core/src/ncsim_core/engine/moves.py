"""What a start or a finish does to links, and then to rates."""

from typing import NamedTuple

from ncsim_core.engine.state import Transfer
from ncsim_core.network import LinkIndex


class Switched(NamedTuple):
    """What a start or a finish did to the links of one route.

    Args:
        route: All links whose number of flows changed.
        on: Those that became active.
        off: Those that became idle.
    """

    route: tuple[LinkIndex, ...]
    on: tuple[LinkIndex, ...]
    off: tuple[LinkIndex, ...]


class Move(NamedTuple):
    """A transfer and the rate that it is about to get, in MB/s, and the link that decides it."""

    flow: Transfer
    rate_MBps: float
    bottleneck: LinkIndex
