"""``docs/equations.md`` names a function and a test for every equation of the paper, truly."""

import importlib.util
import inspect
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]

EQUATIONS = (
    ("1", "eq:fair_share"), ("-", "(execution)"),
    ("2", "eq:pathloss"), ("3", "eq:rxpower"), ("-", "(friis)"), ("-", "(snr)"),
    ("-", "(shadowing)"), ("4", "eq:mcs"), ("5", "eq:csrange"), ("-", "(conflict)"),
    ("-", "(rivals)"), ("6", "eq:tau"), ("7", "eq:p"), ("-", "(fixed-point)"), ("8", "eq:eta"),
    ("-", "(slots)"), ("-", "(station)"), ("9", "eq:sinr"), ("10", "eq:capture"),
    ("-", "(effective-rate)"), ("11", "eq:sinr_factor"), ("12", "eq:combined"),
    ("13", "eq:progress"), ("14", "eq:regret"), ("-", "(winners)"), ("-", "(inversion)"),
    ("-", "(packet-error)"), ("-", "(capture-success)"), ("-", "(airtime)"),
    ("15", "(T_D)"), ("16, 18", "(T_S)"), ("17, 19", "(T_C)"), ("20", "(local-share)"),
    ("-", "(random-order)"),
)  # fmt: skip
"""Numbers and labels of all equations of the paper's source, in order; 15 to 20 have no label."""

CELLS = re.compile(r"(?<!\\)\|")


def rows():
    """Return the cells of each row of the table, without the ``|`` around them."""
    lines = (ROOT / "docs/equations.md").read_text("utf-8").splitlines()
    table = [CELLS.split(line)[1:-1] for line in lines if line.startswith("|")]
    return [[cell.strip(" `") for cell in row] for row in table[2:]]


ROWS = {row[1]: row for row in rows()}


def test_the_table_has_a_row_for_each_equation_and_no_other():
    assert [(row[0], row[1]) for row in rows()] == list(EQUATIONS)
    assert all(len(row) == 5 and all(row) for row in rows())


def test_all_numbers_of_the_paper_are_there():
    numbers = [int(each) for number, _ in EQUATIONS for each in re.findall(r"\d+", number)]

    assert sorted(numbers) == list(range(1, 21))


@pytest.fixture(scope="module")
def breaking():
    spec = importlib.util.spec_from_file_location("breaking", HERE / "breaking.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def noticed(tmp_path_factory):
    """Run the tests of all rows, each while the function beside it does nothing but raise."""
    pairs = [[function, test] for _, _, _, function, test in rows()]
    told = tmp_path_factory.mktemp("breaking") / "noticed.json"
    tests = sorted({test for _, test in pairs})
    command = [sys.executable, "-m", "pytest", "-q", "-p", "breaking", "-p", "no:cacheprovider"]
    environment = {
        "BREAK": json.dumps(pairs),
        "NOTICED": str(told),
        "HYPOTHESIS_PROFILE": "breaking",
        "PYTHONPATH": os.pathsep.join([str(HERE), os.environ.get("PYTHONPATH", "")]),
    }
    run = subprocess.run(
        [*command, *tests], cwd=ROOT, env=os.environ | environment,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr
    return json.loads(told.read_text("utf-8"))


@pytest.mark.parametrize("label", [label for _, label in EQUATIONS])
def test_the_named_test_fails_when_the_named_function_is_broken(label, noticed):
    _, _, _, function, test = ROWS[label]

    assert [function, test] in noticed


@pytest.mark.parametrize("label", [label for _, label in EQUATIONS])
def test_the_function_says_which_equation_it_is(label, breaking):
    number, _, _, function, _ = ROWS[label]
    told = inspect.getdoc(breaking.function_of(function)) or ""

    if label.startswith("eq:"):
        assert label in told or re.search(rf"Eqs?\. {number}\b", told)
    else:
        assert "Source: " in told
