"""Studies come from other people too: what cannot be in one is told of, with the file's name."""

import sqlite3

import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.running import run_sweep
from ncsim_core.sweep.store import STORE_NAME, Store
from ncsim_core.sweep.table import table_of

SWEEP = {
    "sweep": {
        "base": {
            "network": {"type": "line", "nodes": 2, "bandwidth_MBps": 1},
            "dags": {"type": "chain", "tasks": 2},
            "config": {"scheduler": "round_robin"},
        },
        "replicate": {"seeds": 2},
    }
}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    with run_sweep(SWEEP, folder, executor="serial") as results:
        assert len(list(results)) == 2
    file = sqlite3.connect(folder / STORE_NAME)
    file.execute("PRAGMA journal_mode=DELETE")
    file.close()
    return (folder / STORE_NAME).read_bytes()


@pytest.fixture
def study(whole, tmp_path):
    (tmp_path / STORE_NAME).write_bytes(whole)
    return tmp_path


def used(study):
    """Use a study as verbs do."""
    with Store(study, must_exist=True) as store, Store(None) as other:
        other.merge(store)
        return table_of(store), store.counts(), store.errors(3)


CHANGES = {
    "UPDATE plan SET document = 'no JSON'": "is damaged: Expecting value",
    "UPDATE plan SET document = '[]'": "is damaged: list indices",
    "UPDATE plan SET document = '{}'": "is damaged: 'name' is missing",
    "UPDATE plan SET document = replace(document, 'chain', 'fork_join')": "is not the one",
    "UPDATE plan SET runs = 'many'": "is not the one",
    "UPDATE member SET point = '[1]'": "is no run of the sweep",
    "UPDATE member SET seed = 'first'": "is no run of the sweep",
    "UPDATE result SET makespan_us = 'soon'": "is no result",
    "UPDATE result SET wall_s = x'00'": "is no result",
    "UPDATE result SET error = x'ff'": "is no result",
    "DROP TABLE result": "",
    "ALTER TABLE plan RENAME COLUMN turn TO round": "cannot be used as a study: no such column",
    "UPDATE meta SET value = '2'": "is of format 2, this ncsim reads 1",
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_study_that_was_changed_is_told_of_or_has_no_results(change, study):
    with sqlite3.connect(study / STORE_NAME) as file:
        file.execute(change)

    if CHANGES[change]:
        with pytest.raises(ScenarioError, match=CHANGES[change]) as caught:
            used(study)
        assert str(study) in str(caught.value)
    else:
        assert used(study)[1] == {}


@pytest.mark.parametrize("junk", [b"", b"no database", b"SQLite format 3\0" + bytes(4096)])
def test_a_file_that_is_no_database_is_told_of(junk, tmp_path):
    (tmp_path / STORE_NAME).write_bytes(junk)

    with pytest.raises(ScenarioError, match=r"holds no sweep|not a database|malformed"):
        used(tmp_path)


def test_a_file_that_was_cut_is_told_of(study, whole):
    (study / STORE_NAME).write_bytes(whole[: len(whole) // 2])

    with pytest.raises(ScenarioError, match=STORE_NAME):
        used(study)
