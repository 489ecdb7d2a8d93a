"""Factories of the SAGA schedulers that have options; defaults are SAGA's own."""

from typing import Literal

from ncsim_core.context import BuildContext
from ncsim_core.contracts.scheduler import Scheduler

from ncsim_saga.schedulers.native_scheduler import NativeScheduler
from ncsim_saga.schedulers.saga_scheduler import SagaScheduler


def heft(context: BuildContext, *, engine: Literal["auto", "native", "saga"] = "auto") -> Scheduler:
    """Return heterogeneous earliest finish time."""
    return NativeScheduler(context, name="heft", engine=engine)


def cpop(context: BuildContext, *, engine: Literal["auto", "native", "saga"] = "auto") -> Scheduler:
    """Return critical path on one processor."""
    return NativeScheduler(context, name="cpop", engine=engine)


def fcp(context: BuildContext, *, priority_queue_size: int | None = None) -> Scheduler:
    """Return the fast critical path scheduler."""
    return SagaScheduler(context, name="fcp", priority_queue_size=priority_queue_size)


def gdl(context: BuildContext, *, dynamic_level: Literal[1, 2] = 2) -> Scheduler:
    """Return the generalised dynamic level scheduler."""
    return SagaScheduler(context, name="gdl", dynamic_level=dynamic_level)


def smt(
    context: BuildContext, *, epsilon: float = 1e-3, solver_name: str | None = None
) -> Scheduler:
    """Return the scheduler that asks a solver."""
    return SagaScheduler(context, name="smt", epsilon=epsilon, solver_name=solver_name)


def wba(context: BuildContext, *, alpha: float = 0.5) -> Scheduler:
    """Return the workflow-based allocation scheduler, which draws by the run's seed."""
    return SagaScheduler(context, name="wba", alpha=alpha)
