"""What a start or a finish does to links, and then to rates."""

from collections.abc import Sequence
from typing import TypeAlias

from ncsim_core.engine.state import Transfer
from ncsim_core.network import LinkIndex

Touched: TypeAlias = tuple[Sequence[LinkIndex], Sequence[LinkIndex], Sequence[LinkIndex]]
"""The links of one route that became active, those that became idle, and those that other transfers
use too."""

Move: TypeAlias = tuple[int, Transfer, float, LinkIndex]
"""Number of a transfer, the transfer, the rate that it is about to get in MB/s, and the link that
decides it."""
