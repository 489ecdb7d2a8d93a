import os
import subprocess
import sys
import time
from unittest.mock import patch

import pytest
from ncsim_viz.server.entries import Entries
from ncsim_viz.server.errors import RequestError
from ncsim_viz.server.library import Library

HEADER = (
    '{"format":"ncsim-trace","version":"1.0","time_unit":"us","level":"full","software":"x",'
    '"scenario":"small","scenario_sha256":"","seed":1,"plugins":{},"sections":{},"nodes":[],'
    '"links":[],"kinds":{}}\n'
)
DONE = (
    '{"t":5000000,"k":"done","status":"completed","makespan_us":5000000,"events":1,"detail":"",'
    '"counts":{}}\n'
)


def put(folder, text=HEADER + DONE):
    folder.mkdir(parents=True)
    (folder / "trace.jsonl").write_text(text)
    return folder


def partial(folder, name, process, text=HEADER, age_s=60):
    made = put(folder / f".{name}.partial-{process}-0123abcd", text)
    os.utime(made / "trace.jsonl", (time.time() - age_s,) * 2)
    return made


@pytest.fixture
def ended_process():
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    return child.pid


def ids(root):
    return {place.id: place.stage for place in Library(root).places()}


def test_runs_are_found_at_any_depth_under_their_path(tmp_path):
    put(tmp_path / "a")
    put(tmp_path / "b" / "c d" / "e")

    assert ids(tmp_path) == {"a": "finished", "b/c d/e": "finished"}


def test_the_folder_may_itself_be_a_run(tmp_path):
    put(tmp_path / "run")

    assert ids(tmp_path / "run") == {".": "finished"}


def test_a_run_being_written_is_found_under_the_name_it_will_have(tmp_path):
    partial(tmp_path, "new", os.getpid())

    assert ids(tmp_path) == {"new": "running"}
    assert Library(tmp_path).find("new").trace is not None


def test_what_a_killed_run_left_is_told_from_a_live_one(tmp_path, ended_process):
    partial(tmp_path, "killed", ended_process)

    assert ids(tmp_path) == {"killed": "abandoned"}


def test_a_run_of_another_machine_lives_as_long_as_its_trace_grows(tmp_path, ended_process):
    partial(tmp_path, "elsewhere", ended_process, age_s=1)

    assert ids(tmp_path) == {"elsewhere": "running"}


def test_a_run_that_is_made_again_is_shown_live_and_its_remains_never(tmp_path, ended_process):
    put(tmp_path / "again")
    partial(tmp_path, "again", os.getpid())
    put(tmp_path / "done")
    partial(tmp_path, "done", ended_process)

    assert ids(tmp_path) == {"again": "running", "done": "finished"}


@pytest.mark.parametrize(
    "identity",
    [
        "../secret", "..", "a/../../secret", "/etc", "//etc", "a//b", "", "./a", ".hidden", "a/.x",
        "a\0b", "..\\secret", "outside", "outside/deep", "loop", "a" * 5000, "nothing",
        "%2e%2e/secret",
        ".a.partial-1-0123abcd",
    ],
)  # fmt: skip
def test_ids_that_lead_out_or_nowhere_are_refused(tmp_path, identity):
    root = tmp_path / "root"
    put(root / "a")
    put(root / ".hidden")
    secret = put(tmp_path / "secret")
    put(secret / "deep")
    (root / "outside").symlink_to(secret)
    (root / "loop").symlink_to(root / "loop")

    with pytest.raises(RequestError):
        Library(root).find(identity)


@pytest.mark.parametrize("name", ["trace.jsonl", "scenario.yaml", "metrics.json"])
def test_a_run_with_a_file_that_leads_out_is_not_shown(tmp_path, name):
    root = tmp_path / "root"
    run = put(root / "a")
    (tmp_path / "secret").write_text("secret")
    (run / name).unlink(missing_ok=True)
    (run / name).symlink_to(tmp_path / "secret")

    assert ids(root) == {}
    with pytest.raises(RequestError):
        Library(root).find("a")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_folder_that_may_not_be_read_hides_nothing_else(tmp_path):
    put(tmp_path / "a")
    put(tmp_path / "closed").chmod(0)
    try:
        assert ids(tmp_path) == {"a": "finished"}
    finally:
        (tmp_path / "closed").chmod(0o700)


def test_a_list_says_how_runs_ended(tmp_path, ended_process):
    put(tmp_path / "whole")
    put(tmp_path / "torn", HEADER)
    put(tmp_path / "broken", "no trace\n")
    partial(tmp_path, "killed", ended_process)
    library = Library(tmp_path)

    document = Entries(library).document()

    found = {each["id"]: each["status"] for each in document["entries"]}
    assert found == {
        "whole": "completed", "torn": "truncated", "broken": "truncated", "killed": "abandoned",
    }  # fmt: skip
    whole = next(each for each in document["entries"] if each["id"] == "whole")
    assert (whole["name"], whole["makespan_s"], whole["is_live"]) == ("small", 5.0, False)


def test_a_list_notices_that_a_process_has_died(tmp_path, ended_process):
    made = partial(tmp_path, "run", ended_process, age_s=1)
    entries = Entries(Library(tmp_path))
    before = entries.document()["entries"][0]["status"]
    time_s = (made / "trace.jsonl").stat().st_mtime
    with patch("ncsim_viz.server.library.time.time", lambda: time_s + 60):
        after = entries.document()["entries"][0]["status"]

    assert (before, after) == ("running", "abandoned")


def test_a_list_follows_changes(tmp_path):
    run = put(tmp_path / "run", HEADER)
    entries = Entries(Library(tmp_path))
    before = entries.document()["entries"][0]["status"]
    (run / "trace.jsonl").write_text(HEADER + DONE)

    assert (before, entries.document()["entries"][0]["status"]) == ("truncated", "completed")
