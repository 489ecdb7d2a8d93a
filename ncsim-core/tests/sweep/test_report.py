import csv
import io

import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.report import paired, policies, policy_totals, summary
from ncsim_core.sweep.table import MEASURES, Table


def runs(rows):
    """Return a table of (scheduler, interference, seed, makespan) with everything else empty."""
    columns = ("scheduler", "interference", "seed", *MEASURES)
    filled = [
        (s, i, seed, "failed" if m is None else "completed", m, *([None] * (len(MEASURES) - 2)))
        for s, i, seed, m in rows
    ]
    return Table(columns, tuple(filled), "study")


INVERSION = runs(
    [
        ("heft", "none", 1, 3.0),
        ("heft", "csma_bianchi", 1, 12.0),
        ("cpop", "none", 1, 4.0),
        ("cpop", "csma_bianchi", 1, 8.0),
    ]
)


def test_a_failed_run_enters_no_mean_and_is_counted():
    table = summary(
        runs([("heft", "none", seed, m) for seed, m in ((1, 1.0), (2, 3.0), (3, None))])
    )
    record = table.to_dicts()[0]

    assert record["mean_makespan_s"] == 2.0
    assert record["median_makespan_s"] == 2.0
    assert (record["runs"], record["left_out"]) == (2, 1)


def test_an_inversion_is_told_with_its_regret():
    matrix = policies(INVERSION, "scheduler", "interference")
    record = matrix.to_dicts()[0]
    totals = dict(policy_totals(matrix).rows)

    assert (record["solo_winners"], record["full_winners"]) == ("heft", "cpop")
    assert record["inversion"] is True
    assert record["regret"] == 0.5
    assert record["slowdown"] == 4.0
    assert totals["rank inversions"] == 1


def test_differences_are_taken_seed_by_seed():
    table = paired(
        runs(
            [
                ("heft", mode, seed, m)
                for mode, seed, m in (
                    ("none", 1, 1.0),
                    ("none", 2, 5.0),
                    ("csma_bianchi", 1, 2.0),
                    ("csma_bianchi", 2, 8.0),
                )
            ]
        ),
        "interference",
    )
    record = table.to_dicts()[0]

    assert record["difference"] == "csma_bianchi - none"
    assert record["mean_makespan_s"] == 2.0
    assert record["pairs"] == 2


def test_a_column_that_is_not_varied_is_refused():
    with pytest.raises(ScenarioError, match="'routing' is not varied"):
        paired(INVERSION, "routing")


def test_csv_keeps_full_precision_and_leaves_gaps_empty():
    table = Table(("a_b", "c"), ((1 / 3, None),))

    assert list(csv.reader(io.StringIO(table.to_csv()))) == [["a_b", "c"], [repr(1 / 3), ""]]


def test_latex_is_booktabs_with_special_characters_escaped():
    text = Table(("a_b", "c"), ((1, "x%"),)).to_latex()

    assert r"a\_b & c \\" in text
    assert r"1 & x\% \\" in text
    assert text.startswith(r"\begin{tabular}{rl}")
    assert r"\toprule" in text


def test_markdown_has_a_rule_below_its_head():
    assert Table(("a", "b"), ((1, None),)).to_markdown() == "| a | b |\n| --- | --- |\n| 1 | - |"
