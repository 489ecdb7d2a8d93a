"""Simulates DAG workflows on networked compute nodes whose wireless links slow each other down.

>>> from ncsim_core import simulate
>>> simulate("examples/two_hop.yaml", interference="none").makespan_s  # doctest: +SKIP
8.643389
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ncsim_core.api import RunResult as RunResult
    from ncsim_core.api import prepare as prepare
    from ncsim_core.api import simulate as simulate
    from ncsim_core.engine.observer import BatchObserver as BatchObserver
    from ncsim_core.engine.observer import Observer as Observer
    from ncsim_core.engine.outcome import RunStatus as RunStatus
    from ncsim_core.engine.setup import Limits as Limits
    from ncsim_core.engine.simulation import Simulation as Simulation
    from ncsim_core.errors import NcsimError as NcsimError
    from ncsim_core.scenario.loader import load_scenario as load_scenario
    from ncsim_core.sweep.running import run_sweep as run_sweep

__version__ = "0.1.0"

_ROOMS = {
    "BatchObserver": "ncsim_core.engine.observer",
    "Limits": "ncsim_core.engine.setup",
    "NcsimError": "ncsim_core.errors",
    "Observer": "ncsim_core.engine.observer",
    "RunResult": "ncsim_core.api",
    "RunStatus": "ncsim_core.engine.outcome",
    "Simulation": "ncsim_core.engine.simulation",
    "load_scenario": "ncsim_core.scenario.loader",
    "prepare": "ncsim_core.api",
    "run_sweep": "ncsim_core.sweep.running",
    "simulate": "ncsim_core.api",
}

__all__ = [
    "BatchObserver",
    "Limits",
    "NcsimError",
    "Observer",
    "RunResult",
    "RunStatus",
    "Simulation",
    "load_scenario",
    "prepare",
    "run_sweep",
    "simulate",
]


def __getattr__(name: str) -> object:
    if name not in _ROOMS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_ROOMS[name]), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_ROOMS])
