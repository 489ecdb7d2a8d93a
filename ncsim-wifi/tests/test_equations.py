"""``docs/equations.md`` names a function and a test for every equation of the paper, truly."""

import importlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

LABELS = (
    "eq:fair_share", "eq:pathloss", "eq:rxpower", "eq:mcs", "eq:csrange", "eq:tau", "eq:p",
    "eq:eta", "eq:sinr", "eq:capture", "eq:sinr_factor", "eq:combined", "eq:progress", "eq:regret",
)  # fmt: skip
"""Every label of an equation in the paper's source, in order; so they are numbered 1 to 14."""

UNLABELLED = ("T_D", "T_S", "T_C", "local-share")
"""Displayed equations of Appendix A that have a number and no label."""

ROW = re.compile(r"^\| (?P<number>[^|]+) \| (?P<label>[^|]+) \|[^|]*\| `(?P<function>[^`]+)` "
                 r"\| `(?P<test>[^`]+)` \|$", re.MULTILINE)  # fmt: skip


def rows():
    return [match.groupdict() for match in ROW.finditer((ROOT / "docs/equations.md").read_text())]


def test_every_labelled_equation_is_listed_once_and_in_order():
    labelled = [(row["number"], row["label"]) for row in rows() if row["label"].startswith("eq:")]

    assert labelled == [(str(number), label) for number, label in enumerate(LABELS, 1)]


def test_every_displayed_equation_without_label_is_listed():
    assert {f"({name})" for name in UNLABELLED} <= {row["label"] for row in rows()}


def test_no_row_of_the_table_escapes_this_test():
    text = (ROOT / "docs/equations.md").read_text()

    assert len(rows()) == sum(line.startswith("| ") for line in text.splitlines()) - 1


@pytest.mark.parametrize("row", rows(), ids=lambda row: row["label"])
def test_the_function_and_the_test_exist(row):
    module, _, path = row["function"].partition(":")
    found = importlib.import_module(module)
    for name in path.split("."):
        found = getattr(found, name)
    file, _, test = row["test"].partition("::")

    assert callable(found)
    assert re.search(rf"^\s*def {test}\(", (ROOT / file).read_text(), re.MULTILINE)


@pytest.mark.parametrize(
    "row", [row for row in rows() if row["label"].startswith("eq:")], ids=lambda row: row["label"]
)
def test_the_source_of_each_labelled_equation_is_cited_beside_it(row):
    module = importlib.import_module(row["function"].partition(":")[0])
    text = Path(module.__file__).read_text()

    assert row["label"] in text or f"Eq. {row['number']}" in text or row["label"] == "eq:fair_share"
