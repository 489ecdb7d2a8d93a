"""What a report says beyond the trace: numbers and relations, computed by core's Python."""

from pathlib import Path
from typing import Final

from ncsim_core.contracts.interference_model import InterferenceModel
from ncsim_core.errors import NcsimError
from ncsim_core.metrics import compute_metrics
from ncsim_core.metrics.comparison import compare_runs
from ncsim_core.metrics.documents import (
    chain_entry,
    comparison_document,
    explanation_document,
)
from ncsim_core.metrics.explanation import ChainItem, explain_run
from ncsim_core.network import LinkIndex
from ncsim_core.scenario.assembly import assemble
from ncsim_core.scenario.loader import load_scenario
from ncsim_core.trace.output import SCENARIO_NAME
from ncsim_core.trace.records import TraceError
from ncsim_core.trace.run_trace import RunTrace

MAX_LINKS: Final = 200
"""Relations take a question per pair of links; larger networks go without, and the page says so."""


def extras_of(source: Path, run: RunTrace) -> dict[str, object]:
    """Return what accompanies the trace of one run, ready for JSON.

    Args:
        source: The run's folder, or its trace file.
        run: The same run, read.
    """
    folder = source if source.is_dir() else source.parent
    scenario = folder / SCENARIO_NAME
    relations, note = relations_of(scenario, run)
    return {
        "metrics": [compute_metrics(run)],
        "explanation": [explanation_of(run)],
        "relations": relations,
        "note": note,
        "scenario": scenario.read_text("utf-8", "replace") if scenario.is_file() else None,
    }


def explanation_of(run: RunTrace) -> dict[str, object] | None:
    """Return where the makespan went; ``None`` for a run without one."""
    try:
        explanation = explain_run(run)
    except TraceError:
        return None
    tasks = {run.task_label(task.number): task.number for task in run.tasks}
    transfers = {run.transfer_label(each.number): each.number for each in run.transfers}

    def number_of(item: ChainItem) -> int:
        return (tasks if item.kind == "task" else transfers).get(item.label, -1)

    chain = [chain_entry(item) | {"number": number_of(item)} for item in explanation.chain]
    return explanation_document(explanation) | {"chain": chain}


def comparison_of(first: RunTrace, second: RunTrace, names: tuple[str, str]) -> dict[str, object]:
    """Return what changed from one run to another, under the names of both."""
    return {"names": list(names), **comparison_document(compare_runs(first, second))}


def relations_of(scenario: Path, run: RunTrace) -> tuple[dict[str, list[list[int]]] | None, str]:
    """Return for each link who shares its channel and who disturbs it unheard; or why not.

    Asks the run's own interference model through its contract, so that models of third parties
    are shown as well.
    """
    if not scenario.is_file():
        return None, "Relations of links are unknown: no scenario lies beside the trace."
    if len(run.links) > MAX_LINKS:
        return None, f"Relations of links are left out of networks above {MAX_LINKS} links."
    try:
        model = assemble(load_scenario(scenario)).models.interference
        contenders, hidden = _asked(model, len(run.links))
    except NcsimError as error:
        return None, f"Relations of links are unknown: {error}"
    return {"contenders": contenders, "hidden": hidden}, ""


def _asked(model: InterferenceModel, count: int) -> tuple[list[list[int]], list[list[int]]]:
    contenders: list[list[int]] = [[] for _ in range(count)]
    hidden: list[list[int]] = [[] for _ in range(count)]
    for number in range(count):
        other = LinkIndex(number)
        for link in sorted(model.reach([other])):
            if link == other:
                continue
            (competition,) = model.competition([link], {link, other})
            if competition.contenders:
                contenders[link].append(number)
            elif competition.hidden_interferers:
                hidden[link].append(number)
    return contenders, hidden
