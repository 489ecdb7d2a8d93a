"""Which session of the interference model a run works with; all give the same answers.

Compiled kernels pay for themselves only in long runs, since numba takes more than a second to
start: they are used from ``WORTH_KERNELS`` refreshes on, counted over the runs of a process.
"""

import os
import sys
from functools import cache
from importlib.util import find_spec
from typing import TYPE_CHECKING, Final

from ncsim_core.contracts.interference_model import (
    InterferenceModel,
    InterferenceSession,
    PlainSession,
    Unaffected,
)
from ncsim_core.contracts.interference_tables import InterferenceTables
from ncsim_core.engine.boundary import CheckedSession, asked
from ncsim_core.engine.sessions.links_in_use import LinksInUse
from ncsim_core.engine.setup import Setup
from ncsim_core.errors import PluginError
from ncsim_core.models import ComponentIdentity

if TYPE_CHECKING:
    from ncsim_core.engine.sessions.loads import Loads

MAX_LINKS_OF_ROWS: Final = 150
"""Above, arrays are faster than rows of Python numbers; see docs/performance.md."""

WORTH_KERNELS: Final = 80_000
"""Refreshes that save, at some 20 us each, about as much time as it takes to start numba."""

_refreshes_so_far = 0


def session_of(setup: Setup) -> InterferenceSession | None:
    """Return a fresh session for one run, ``None`` if no link ever affects another."""
    model = setup.models.interference
    who = setup.models.identity("interference_model")
    if model.decides_routes:
        return CheckedSession(LinksInUse(model), who)
    if setup.is_global:
        return CheckedSession(PlainSession(model, is_global=True), who)
    tables = asked(who, model.tables)
    if tables is not None:
        check_tables(tables, len(setup.network.links), who)
        refreshes = 2 * len(setup.dependencies)
        return CheckedSession(session_for(model, tables, refreshes), who)
    session = asked(who, model.open_session)
    return None if isinstance(session, Unaffected) else CheckedSession(session, who)


def check_tables(tables: object, link_count: int, who: ComponentIdentity) -> None:
    """Check, once, that tables are such and fit a network.

    Raises:
        PluginError: They do not.
    """
    if not isinstance(tables, InterferenceTables):
        raise PluginError(f"{who}: tables() gave {tables!r}")
    if "loads" not in tables.kept:
        fault = asked(who, lambda: tables.fault(link_count))
        if fault is not None:
            raise PluginError(f"{who} has tables with {fault}")


def session_for(
    model: InterferenceModel, tables: InterferenceTables, refreshes: int
) -> InterferenceSession:
    """Return the session on a model's tables that is fastest for a run of this length.

    Args:
        model: Asked only if its tables are too large for sums of 64 bits: tens of thousands of
            links all within earshot.
        tables: Its tables.
        refreshes: How often it will be updated, about.
    """
    loads = loads_of(tables)
    if not loads.fits:
        return PlainSession(model)
    if is_worth_kernels(refreshes):
        from ncsim_core.engine.sessions.kernel_session import KernelSession

        return KernelSession(loads)
    if tables.link_count <= MAX_LINKS_OF_ROWS:
        from ncsim_core.engine.sessions.row_session import RowSession

        return RowSession(loads)
    from ncsim_core.engine.sessions.array_session import ArraySession

    return ArraySession(loads)


def sessions_on(tables: InterferenceTables) -> list[InterferenceSession]:
    """Return a fresh session of every kind that can work on tables; tests prove them equal."""
    from ncsim_core.engine.sessions.array_session import ArraySession
    from ncsim_core.engine.sessions.kernel_session import KernelSession
    from ncsim_core.engine.sessions.row_session import RowSession

    loads = loads_of(tables)
    return [kind(loads) for kind in (RowSession, ArraySession, KernelSession)] if loads.fits else []


def loads_of(tables: InterferenceTables) -> "Loads":
    """Return what follows from tables alone, worked out once for all runs that share them."""
    from ncsim_core.engine.sessions.loads import Loads, loads_from

    loads = tables.kept.get("loads")
    if not isinstance(loads, Loads):
        loads = tables.kept["loads"] = loads_from(tables)
    return loads


def is_worth_kernels(refreshes: int) -> bool:
    """Return whether a run of this length, after those so far, should use compiled kernels."""
    global _refreshes_so_far  # noqa: PLW0603 - a matter of the process, and of speed only
    if not may_compile():
        return False
    _refreshes_so_far += refreshes
    return "numba" in sys.modules or _refreshes_so_far >= WORTH_KERNELS


def may_compile() -> bool:
    """Return whether numba is installed and ``NCSIM_PURE=1`` does not forbid it."""
    return os.environ.get("NCSIM_PURE", "") != "1" and _has_numba()


@cache
def _has_numba() -> bool:
    return find_spec("numba") is not None
