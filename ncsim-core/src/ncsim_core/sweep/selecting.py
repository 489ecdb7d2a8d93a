"""Single runs and columns of a study, named in a word: ``study@scheduler=heft,seed=3``.

A study keeps no traces. A run that somebody wants to look into is carried out once more, which
gives the same trace, and is checked against what the study holds.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple

from ncsim_core.engine.setup import Limits
from ncsim_core.engine.simulation import Simulation
from ncsim_core.errors import ScenarioError
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.wording import did_you_mean
from ncsim_core.sweep.axes import Run
from ncsim_core.sweep.formatting import shown_value
from ncsim_core.sweep.plan import SweepPlan
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.sweep.store import Store
from ncsim_core.sweep.where import spellings
from ncsim_core.sweep.worker import ResultRow
from ncsim_core.trace.recorder import RunRecorder
from ncsim_core.trace.records import TraceHeader
from ncsim_core.trace.run_trace import RunTrace
from ncsim_core.units import us_from_s

MARK: Final = "@"
SEED: Final = "seed"
_NEXT_VALUE: Final = re.compile(r",(?=[\w.]+=)")


@dataclass(frozen=True)
class Selection:
    """Runs of a study that have some values in common.

    Args:
        study: Its folder.
        values: By column (or its unique last word, or ``seed``), the value as tables show it.
    """

    study: Path
    values: Mapping[str, str]


class Selected(NamedTuple):
    """A run that a selection names: its values by column, seed included, and its result."""

    values: Mapping[str, Any]
    result: ResultRow | None


def selection_of(text: str) -> Selection | None:
    """Return what ``STUDY@COLUMN=VALUE,...`` names; ``None`` for a path.

    Raises:
        ScenarioError: It has the mark, and is not of that form.

    >>> selection_of("study@scheduler=heft,seed=3").values
    {'scheduler': 'heft', 'seed': '3'}
    """
    study, mark, rest = text.rpartition(MARK)
    if not mark or Path(text).exists():
        return None
    pairs = [each.partition("=") for each in _NEXT_VALUE.split(rest)] if rest else []
    if not study or not pairs or any(not name or not equals for name, equals, _ in pairs):
        raise ScenarioError(f"{text!r}: expected STUDY@COLUMN=VALUE,..., e.g. study@seed=3")
    return Selection(Path(study), {name.strip(): value.strip() for name, _, value in pairs})


def matching(store: Store, values: Mapping[str, str]) -> list[Selected]:
    """Return the runs of a study's current sweep that have these values.

    Raises:
        ScenarioError: No run has them; the message says which values there are.
    """
    plan, _ = store.current()
    runs = [
        Selected({**dict(zip(plan.columns, point, strict=True)), SEED: seed}, row)
        for point, seed, row in store.rows()
    ]
    for column, text in resolved(plan, values).items():
        left = [run for run in runs if shown_value(run.values[column]) == text]
        if not left:
            raise ScenarioError(_no_run(column, text, runs))
        runs = left
    return runs


def resolved(plan: SweepPlan, values: Mapping[str, str]) -> dict[str, str]:
    """Return values by whole column.

    Raises:
        ScenarioError: A name is no column of the sweep.
    """
    names = {**spellings(plan.columns), SEED: SEED}
    for name in values:
        if name not in names:
            meant = did_you_mean(name, names)
            hint = f"did you mean {meant!r}? " if meant else ""
            columns = ", ".join([*plan.columns, SEED])
            raise ScenarioError(f"{name!r} is no column of the study; {hint}there are {columns}")
    return {names[name]: text for name, text in values.items()}


def recalled(selection: Selection) -> RunTrace:
    """Return the one run that a selection names, carried out once more.

    Raises:
        ScenarioError: It names no run or several, or the run does not end as it did in the study.
    """
    with Store(selection.study, must_exist=True) as store:
        plan, _ = store.current()
        found = matching(store, selection.values)
    if len(found) > 1:
        raise ScenarioError(_several(found, resolved(plan, selection.values)))
    return _carried_out(plan, found[0])


def _carried_out(plan: SweepPlan, selected: Selected) -> RunTrace:
    values = dict(selected.values)
    seed = values.pop(SEED)
    scenario = Resolver(plan).scenario(Run(0, tuple(values.values()), seed))
    recorder = RunRecorder(TraceHeader.of(scenario))
    assembly = assemble(scenario)
    max_time_s = plan.limits.max_time_s
    limits = Limits(plan.limits.max_events, None if max_time_s is None else us_from_s(max_time_s))
    Simulation(assembly.network, assembly.models, limits, [recorder]).run()
    run = recorder.run_trace()
    kept = selected.result
    if kept is not None and kept.makespan_us not in (None, run.end.makespan_us):
        raise ScenarioError(
            f"the study holds a makespan of {kept.makespan_us} us, done again the run gives "
            f"{run.end.makespan_us} us; other versions of plug-ins are installed now. Run the "
            "sweep again"
        )
    return run


def _no_run(column: str, text: str, runs: Sequence[Selected]) -> str:
    there = list(dict.fromkeys(shown_value(run.values[column]) for run in runs))
    return f"no run has {column}={text}; there are {', '.join(there)}"


def _several(found: Sequence[Selected], given: Mapping[str, str]) -> str:
    """Return which columns are still open when one run is wanted."""
    first = found[0].values
    still_open = {
        column: list(dict.fromkeys(shown_value(run.values[column]) for run in found))
        for column in first
        if column not in given
    }
    choices = "; ".join(f"{c}={'|'.join(v)}" for c, v in still_open.items() if len(v) > 1)
    return f"{len(found)} runs are meant; say which: {choices}"
