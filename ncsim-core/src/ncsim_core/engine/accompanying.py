"""Tells plug-ins that a run starts, and how it ended; whoever carries out a run uses it."""

from collections.abc import Iterator
from contextlib import contextmanager

from ncsim_core.engine.outcome import RunStatus
from ncsim_core.engine.simulation import Simulation
from ncsim_core.plugins import RunInfo
from ncsim_core.registry import get_registry


@contextmanager
def accompanied(simulation: Simulation, name: str, seed: int) -> Iterator[None]:
    """Call the run hooks of all plug-ins before and after a simulation is carried out.

    A simulation that was left before its end has reached a limit of its user's. One that an
    exception ends is not told of again.

    Args:
        simulation: Carried out inside the ``with`` block.
        name: Of the scenario.
        seed: Of the run.

    Raises:
        PluginError: A hook raised.
    """
    registry = get_registry()
    run = RunInfo(name, seed, simulation.setup.models.identities)
    registry.announce_start(run)
    yield
    outcome = simulation.outcome
    status = RunStatus.LIMIT_REACHED if outcome is None else outcome.status
    registry.announce_finish(run, str(status), None if outcome is None else outcome.makespan_s)
