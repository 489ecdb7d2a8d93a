"""``docs/saga.md`` says for each scheduler whether it depends on set order, and what is done."""

from pathlib import Path

import pytest
from ncsim_saga.catalogue import SCHEDULERS

PAGE = Path(__file__).parents[2] / "docs/saga.md"
INSTALLED = {name: entry for name, entry in SCHEDULERS.items() if not entry.requires}


def statements():
    """Return by scheduler the cells of its row in the table of set orders."""
    table = PAGE.read_text("utf-8").partition("depends on set order?")[2].partition("\n\n")[0]
    rows = [line.strip("| ").split(" | ") for line in table.splitlines() if line.startswith("| `")]
    return {row[0].strip("`"): row[1:] for row in rows}


def test_every_scheduler_has_its_statement_and_no_other_has():
    assert list(statements()) == sorted(INSTALLED)
    assert all(len(row) == 4 and all(row) for row in statements().values())


@pytest.mark.parametrize("name", sorted(INSTALLED))
def test_what_the_page_says_is_done_is_what_the_catalogue_asks_for(name):
    entry, (*_, done) = INSTALLED[name], statements()[name]

    assert ("child process" in done) == entry.is_planned_in_child
    assert ("seeded by the run's `seed`" in done) == entry.draws
    assert ("native planner" in done) == ("engine" in entry.options)
