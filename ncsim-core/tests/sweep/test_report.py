import csv
import io

import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.report import (
    means,
    paired,
    policies,
    policy_cases,
    policy_totals,
    summary,
)
from ncsim_core.sweep.table import MEASURES, Table


def runs(rows):
    """Return a table of (scheduler, interference, seed, makespan) with everything else empty."""
    columns = ("scheduler", "interference", "seed", *MEASURES)
    filled = [
        (s, i, seed, "failed" if m is None else "completed", m, *([None] * (len(MEASURES) - 2)))
        for s, i, seed, m in rows
    ]
    return Table(columns, tuple(filled), "study", heads=3)


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


def test_means_may_be_taken_over_columns_too():
    rows = means(INVERSION, ["interference"], "makespan_s").to_dicts()

    assert [(r["interference"], r["mean_makespan_s"], r["runs"]) for r in rows] == [
        ("none", 3.5, 2),
        ("csma_bianchi", 10.0, 2),
    ]


def test_an_inversion_is_told_with_its_regret():
    matrix = policies(INVERSION, "scheduler", "interference")
    record = matrix.to_dicts()[0]
    totals = dict(policy_totals(matrix).rows)

    assert (record["solo_winners"], record["full_winners"]) == ("heft", "cpop")
    assert record["inversion"] is True
    assert record["regret"] == 0.5
    assert record["slowdown"] == 4.0
    assert totals["rank inversions"] == 1


def test_of_several_modes_one_is_said_to_mean_full():
    more = [("heft", "csma_spatial", 1, 6.0), ("cpop", "csma_spatial", 1, 9.0)]
    table = runs([*((*row[:3], row[4]) for row in INVERSION.rows), *more])

    with pytest.raises(ScenarioError, match="say which means Full"):
        policies(table, "scheduler", "interference")
    with pytest.raises(ScenarioError, match="has no 'csma' beside 'none'"):
        policies(table, "scheduler", "interference", full="csma")
    found = [
        policies(table, "scheduler", "interference", full=full).to_dicts()[0]["regret"]
        for full in ("csma_bianchi", "csma_spatial")
    ]
    assert found == [0.5, 0.0]


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
    assert record["mean_difference"] == 2.0
    assert record["pairs"] == 2


def test_a_column_that_is_not_varied_is_refused():
    with pytest.raises(ScenarioError, match="'routing' is not varied"):
        paired(INVERSION, "routing")


def test_csv_keeps_full_precision_and_leaves_gaps_empty():
    table = Table(("a_b", "c"), ((1 / 3, None),))

    assert list(csv.reader(io.StringIO(table.to_csv()))) == [["a_b", "c"], [repr(1 / 3), ""]]


def test_latex_is_booktabs_with_special_characters_escaped():
    text = Table(("a_b", "c"), ((1, "x%"), (None, r"{\~^#$&}")), "50% of\nit").to_latex()

    assert text.splitlines() == [
        "% 50% of it",
        r"% \usepackage{booktabs}",
        r"\begin{tabular}{rl}",
        r"\toprule",
        r"a\_b & c \\",
        r"\midrule",
        r"1 & x\% \\",
        r"-- & \{\textbackslash{}\textasciitilde{}\textasciicircum{}\#\$\&\} \\",
        r"\bottomrule",
        r"\end{tabular}",
    ]


def test_markdown_has_numbers_to_the_right_and_keeps_bars_in_their_cell():
    text = Table(("a", "b|c"), ((1.0, "x|y"),), "what").to_markdown()

    assert text == "**what**\n\n| a | b\\|c |\n| ---: | --- |\n| 1.000 | x\\|y |"


def test_measured_numbers_of_a_column_have_equally_many_digits_and_parameters_none_too_many():
    table = Table(("load", "mean"), ((0.5, 10.182), (2.0, 9.47843), (1, 1e-6)), heads=1)

    assert table.to_markdown(digits=2).splitlines()[2:] == [
        "| 0.5 | 10.18 |",
        "| 2 | 9.48 |",
        "| 1 | 0.00 |",
    ]


def test_cases_are_taken_over_seeds():
    rows = [
        (policy, mode, seed, makespan)
        for seed, heft, cpop in ((1, 12.0, 8.0), (2, 8.0, 8.0), (3, 8.0, None))
        for policy, mode, makespan in (
            ("heft", "none", 3.0),
            ("cpop", "none", 4.0),
            ("heft", "csma_bianchi", heft),
            ("cpop", "csma_bianchi", cpop),
        )
    ]
    record = policy_cases(policies(runs(rows), "scheduler", "interference")).to_dicts()[0]

    assert (record["cases"], record["inversions"], record["left_out"]) == (3, 1, 0)
    assert record["mean_regret"] == pytest.approx(0.5 / 3)
    assert (record["median_regret"], record["largest_regret"]) == (0.0, 0.5)
    assert record["mean_slowdown"] == pytest.approx((4 + 8 / 3 + 8 / 3) / 3)


def test_pairs_that_a_condition_leaves_out_have_no_row():
    rows = [("heft", "none", 1, 3.0), ("cpop", "none", 1, 4.0), ("heft", "csma_bianchi", 1, 5.0)]

    assert [row[0] for row in paired(runs(rows), "scheduler").rows] == ["none"]


@pytest.mark.parametrize("make", [summary, lambda r, m: paired(r, "scheduler", m)])
def test_what_is_no_measure_is_refused_with_a_suggestion(make):
    with pytest.raises(ScenarioError, match="did you mean 'makespan_s'"):
        make(INVERSION, "makespans")


MIXED = Table(
    ("scheduler", "load", "option", "note"),
    (
        ("heft", 1, {"type": "fcp", "options": {"k": 2}}, None),
        ("cpop", 2.5, "heft", None),
    ),
)


def test_columns_are_of_one_type():
    columns = MIXED.to_columns()

    assert columns["load"] == [1.0, 2.5]
    assert columns["option"] == ['{"options":{"k":2},"type":"fcp"}', "heft"]


def test_pandas_takes_a_table():
    pandas = pytest.importorskip("pandas")
    frame = MIXED.to_pandas()

    assert frame["load"].dtype == "float64"
    assert frame.equals(pandas.DataFrame(MIXED.to_columns()))


def test_polars_takes_a_table():
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame(MIXED.to_columns())

    assert frame["load"].to_list() == [1.0, 2.5]


def test_parquet_holds_what_the_table_holds(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    INVERSION.write_parquet(tmp_path / "new" / "runs.parquet")
    back = parquet.read_table(tmp_path / "new" / "runs.parquet").to_pylist()

    assert back == INVERSION.to_dicts()


def test_latex_heads_name_quantity_and_unit():
    text = Table(("dags.payload_MB", "round_robin", "mean_makespan_s"), ((1, 2, 3.0),)).to_latex()

    assert r"payload (MB) & round\_robin & mean makespan (s) \\" in text
