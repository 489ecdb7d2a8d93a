"""The compiled functions that are called from outside, as numba keeps them on disk.

All are made here, and enclose what stands for their sources: see ``state_of``.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Final

from ncsim_core.compiling import kept_on_disk, state_of

from ncsim_wifi.quantities import FloatArray
from ncsim_wifi.spatial.attempts import Attempts, Contenders, Exchange
from ncsim_wifi.spatial.chains import Given, SideRates
from ncsim_wifi.spatial.compiled import attempts, chains, energy, gaps, occupancy, overlap
from ncsim_wifi.spatial.energy import Silenced, Silencing
from ncsim_wifi.spatial.forms import Forms
from ncsim_wifi.spatial.gaps import Interferers, Survival, Windows
from ncsim_wifi.spatial.occupancy import Occupancy, SetTable
from ncsim_wifi.spatial.overlap import Helped


def loops_of(sources: str) -> Forms:
    """Return the compiled loops.

    Args:
        sources: Stands for what they are compiled from; not empty.
    """
    attempts_of, silenced_by, exact_occupancy = _loops_over_stations(sources)
    survival, helped_kill, joint_stages, stage_means = _loops_over_relations(sources)
    return Forms(
        attempts_of=attempts_of,
        survival=survival,
        joint_stages=joint_stages,
        stage_means=stage_means,
        silenced_by=silenced_by,
        exact_occupancy=exact_occupancy,
        helped_kill=helped_kill,
    )


AttemptsOf = Callable[[Contenders, Exchange], Attempts]
SilencedBy = Callable[[Silencing, FloatArray], Silenced]
ExactOccupancy = Callable[[SetTable, FloatArray], Occupancy]


def _loops_over_stations(sources: str) -> tuple[AttemptsOf, SilencedBy, ExactOccupancy]:
    def attempts_of(contenders: Contenders, times: Exchange) -> Attempts:
        assert sources
        return attempts.attempts_of(contenders, times)

    def silenced_by(tables: Silencing, on: FloatArray) -> Silenced:
        assert sources
        return energy.silenced_by(tables, on)

    def exact_occupancy(table: SetTable, activity: FloatArray) -> Occupancy:
        assert sources
        return occupancy.exact_occupancy(table, activity)

    return kept_on_disk(attempts_of), kept_on_disk(silenced_by), kept_on_disk(exact_occupancy)


Survives = Callable[[Interferers, Windows], Survival]
HelpedKill = Callable[[Helped, FloatArray, FloatArray, FloatArray, FloatArray], FloatArray]
JointStages = Callable[[SideRates, SideRates], FloatArray]
StageMeans = Callable[[Given, FloatArray], FloatArray]


def _loops_over_relations(sources: str) -> tuple[Survives, HelpedKill, JointStages, StageMeans]:
    def survival(met: Interferers, windows: Windows) -> Survival:
        assert sources
        return gaps.survival(met, windows)

    def helped_kill(
        helped: Helped,
        on: FloatArray,
        on_air_us: FloatArray,
        busy_us: FloatArray,
        eager: FloatArray,
    ) -> FloatArray:
        assert sources
        return overlap.helped_kill(helped, on, on_air_us, busy_us, eager)

    def joint_stages(one: SideRates, two: SideRates) -> FloatArray:
        assert sources
        return chains.joint_stages(one, two)

    def stage_means(given: Given, by_stage: FloatArray) -> FloatArray:
        assert sources
        return chains.stage_means(given, by_stage)

    return (
        kept_on_disk(survival),
        kept_on_disk(helped_kill),
        kept_on_disk(joint_stages),
        kept_on_disk(stage_means),
    )


def _sources() -> str:
    """Return what changes whenever a file does that the loops are compiled from."""
    here = Path(__file__).parent
    files = [*sorted(here.glob("*.py")), *sorted(here.parent.glob("*.py"))]
    files.append(here.parents[1] / "mac" / "timing.py")
    return state_of(files)


LOOPS: Final = loops_of(_sources())
