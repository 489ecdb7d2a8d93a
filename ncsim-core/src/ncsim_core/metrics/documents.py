"""Explanations and comparisons as plain data, for JSON on the command line and in reports."""

import math

from ncsim_core.metrics.comparison import Comparison
from ncsim_core.metrics.explanation import ChainItem, Explanation


def explanation_document(explanation: Explanation) -> dict[str, object]:
    """Return an explanation ready for JSON; all times in microseconds."""
    return {
        "makespan_us": explanation.makespan_us,
        "totals_us": dict(explanation.totals),
        "chain": [chain_entry(item) for item in explanation.chain],
    }


def chain_entry(item: ChainItem) -> dict[str, object]:
    """Return one item of the binding chain ready for JSON; all times in microseconds."""
    return {
        "kind": item.kind,
        "label": item.label,
        "place": list(item.place),
        "start_us": item.start_us,
        "end_us": item.end_us,
        "parts_us": dict(item.parts),
    }


def comparison_document(comparison: Comparison) -> dict[str, object]:
    """Return a comparison ready for JSON; changes in microseconds."""
    ratio = comparison.makespan_ratio
    return {
        "differences": [each._asdict() for each in comparison.differences],
        "status": [comparison.first_status, comparison.second_status],
        "makespan_s": [comparison.first_makespan_s, comparison.second_makespan_s],
        "makespan_ratio": None if ratio == math.inf else ratio,  # JSON has no infinity
        "regret": [None if each == math.inf else each for each in comparison.regrets],
        "tasks": [
            {
                "label": change.label,
                "nodes": [change.first_node, change.second_node],
                "ready_us": change.ready_us,
                "wait_us": change.wait_us,
                "compute_us": change.compute_us,
                "ended_us": change.ended_us,
                "why": change.why,
            }
            for change in comparison.tasks
        ],
        "transfers": [
            {
                "label": change.label,
                "routes": [list(change.first_route), list(change.second_route)],
                "took_us": change.took_us,
                "parts_us": dict(change.parts),
                "why": change.why,
            }
            for change in comparison.transfers
        ],
        "unmatched": list(comparison.unmatched),
    }
