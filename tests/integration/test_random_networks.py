"""The numbers in examples/random-networks/README.md are those of its study."""

import re
from pathlib import Path

import pytest
from ncsim_core.sweep.report import policies, policy_cases, policy_totals
from ncsim_core.sweep.running import run_sweep

FOLDER = Path(__file__).parents[2] / "examples" / "random-networks"


def page_row(record):
    """Return a row of the page's table as the study gives it."""
    percent = {k: 100 * record[k] for k in ("mean_regret", "regret_low", "regret_high")}
    regret = "{mean_regret:.1f} % [{regret_low:.1f}, {regret_high:.1f}]".format(**percent)
    slowdown = "{mean_slowdown:.2f} [{slowdown_low:.2f}, {slowdown_high:.2f}]".format(**record)
    routing = {"widest_path": "widest path", "minimum_hop": "minimum hop"}[record["routing"]]
    inversions = f"{record['inversions']} of {record['cases']}"
    largest = f"{100 * record['largest_regret']:.0f} %"
    cells = (record["dags.tasks"], routing, inversions, regret, largest, slowdown)
    return f"| {' | '.join(map(str, cells))} |"


@pytest.mark.slow
def test_the_page_says_what_the_study_gives():
    with run_sweep(FOLDER / "factorial.yaml", executor="serial") as results:
        runs = results.table()
    matrix = policies(runs, "scheduler", "interference")
    records = policy_cases(matrix).to_dicts()
    totals = dict(policy_totals(matrix).rows)
    page = re.sub(r"\s+", " ", (FOLDER / "README.md").read_text(encoding="utf-8"))

    for record in records:
        assert page_row(record) in page
    statuses = [row["status"] for row in runs.to_dicts()]
    assert f"1,080 runs; {statuses.count('completed'):,} completed" in page
    lost = [row for row in runs.to_dicts() if row["status"] != "completed"]
    assert {(r["scheduler"], r["seed"], r["dags.tasks"], r["status"]) for r in lost} == {
        ("round_robin", 5, 20, "blocked_wireless")
    }
    assert f"in {totals['rank inversions']} of {totals['cases']} cases" in page
    mean, low, high = (100 * totals[f"mean regret{end}"] for end in ("", ", low", ", high"))
    assert f"{mean:.1f} % in the mean over all cases [{low:.1f}, {high:.1f}]" in page
    assert totals["median regret"] == 0.0
