"""Which session of the interference model a run works with; all give the same answers."""

from typing import TYPE_CHECKING, Final

from ncsim_core.contracts.interference_model import (
    InterferenceModel,
    InterferenceSession,
    PlainSession,
    Unaffected,
)
from ncsim_core.contracts.interference_tables import InterferenceTables
from ncsim_core.engine.boundary import CheckedSession, CheckedTables, asked
from ncsim_core.engine.sessions.links_in_use import LinksInUse
from ncsim_core.engine.setup import Setup
from ncsim_core.errors import PluginError
from ncsim_core.models import ComponentIdentity

if TYPE_CHECKING:
    from ncsim_core.engine.sessions.loads import Loads

MAX_LINKS_OF_ROWS: Final = 150
"""Above, arrays are faster than rows of Python numbers; see docs/performance.md."""


def session_of(setup: Setup) -> CheckedSession | None:
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
        return _checked(session_for(model, tables), who)
    session = asked(who, model.open_session)
    return None if isinstance(session, Unaffected) else CheckedSession(session, who)


def _checked(session: InterferenceSession, who: ComponentIdentity) -> CheckedSession:
    from ncsim_core.engine.sessions.tabled_session import TabledSession

    if isinstance(session, TabledSession):
        return CheckedTables(session, who)
    return CheckedSession(session, who)


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


def session_for(model: InterferenceModel, tables: InterferenceTables) -> InterferenceSession:
    """Return the session on a model's tables that is fastest for networks of their size.

    Args:
        model: Asked only if its tables are too large for sums of 64 bits: tens of thousands of
            links all within earshot.
        tables: Its tables.
    """
    loads = loads_of(tables)
    if not loads.fits:
        return PlainSession(model)
    if tables.link_count <= MAX_LINKS_OF_ROWS:
        from ncsim_core.engine.sessions.row_session import RowSession

        return RowSession(loads)
    from ncsim_core.engine.sessions.array_session import ArraySession

    return ArraySession(loads)


def sessions_on(tables: InterferenceTables) -> list[InterferenceSession]:
    """Return a fresh session of every kind that can work on tables; tests prove them equal."""
    from ncsim_core.engine.sessions.array_session import ArraySession
    from ncsim_core.engine.sessions.row_session import RowSession

    loads = loads_of(tables)
    return [kind(loads) for kind in (RowSession, ArraySession)] if loads.fits else []


def loads_of(tables: InterferenceTables) -> "Loads":
    """Return what follows from tables alone, worked out once for all runs that share them."""
    from ncsim_core.engine.sessions.loads import Loads, loads_from

    loads = tables.kept.get("loads")
    if not isinstance(loads, Loads):
        loads = tables.kept["loads"] = loads_from(tables)
    return loads
