"""Kills, full disks, dying workers and hanging runs, for real."""

import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path
from random import Random

import pytest
import yaml
from ncsim_core.sweep.store import Store
from ncsim_core.sweep.table import table_of
from ncsim_core.testing.fixtures import write_dist

NAUGHTY = """
    import contextlib
    import os
    import time

    from ncsim_core.contracts.scheduler import Scheduler
    from ncsim_core.plugins import Component, hookimpl
    from ncsim_core.workflow import PlacementPlan

    NCSIM_PLUGIN_API = "1.0"
    MOOD = {
        "type": "object",
        "properties": {"mood": {"type": "string", "description": "What it does.", "default": "ok"}},
        "additionalProperties": False,
    }


    @hookimpl
    def ncsim_components():
        return [Component("scheduler", "moody", "moody:Moody", "Has moods.", options=MOOD)]


    class Moody(Scheduler):
        def __init__(self, context, *, mood="ok"):
            self._mood = mood

        def schedule(self, dag, snapshot):
            if self._mood == "die":
                os._exit(9)
            if self._mood == "hang":
                while True:
                    time.sleep(3600)
            while self._mood == "deaf":
                with contextlib.suppress(BaseException):
                    time.sleep(3600)
            if self._mood == "raise":
                raise RuntimeError("no mood for work")
            if self._mood == "slow":
                time.sleep(0.02)
            return PlacementPlan({task.id: snapshot.network.nodes[0].id for task in dag.tasks})
"""


@pytest.fixture
def ncsim(tmp_path):
    write_dist(tmp_path / "site", "moody", {"moody": NAUGHTY})
    environment = os.environ | {"PYTHONPATH": str(tmp_path / "site")}

    def start(*arguments, **more):
        command = [sys.executable, "-c", "from ncsim_core.cli.main import main; main()"]
        return subprocess.Popen(
            [*command, *map(str, arguments)],
            env=environment,
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            **more,
        )

    return start


def sweep_file(tmp_path, vary, **more):
    sweep = {
        "base": {
            "network": {"type": "line", "nodes": 3, "bandwidth_MBps": 1},
            "dags": {"type": "chain", "tasks": 2},
            "config": {"scheduler": {"type": "moody"}, "link_model": "static"},
        },
        "vary": vary,
        **more,
    }
    path = tmp_path / "study.yaml"
    path.write_text(yaml.safe_dump({"sweep": sweep}))
    return path


def finish(process, code):
    out, err = process.communicate(timeout=120)
    assert process.returncode == code, (out, err)
    return out + err


def records(study):
    with Store(study, must_exist=True) as store:
        return table_of(store).to_dicts()


def timeless(study):
    return [{k: v for k, v in row.items() if k != "wall_s"} for row in records(study)]


def finished(study):
    """Return all results by key; an empty study has none."""
    if finished_count(study) == 0:
        return {}
    with closing(sqlite3.connect(f"file:{study}/results.sqlite?mode=ro", uri=True)) as connection:
        return {row[0]: row[1:] for row in connection.execute("SELECT * FROM result")}


def workers_of(parent):
    """Return the processes of a pool that do runs; spawn adds a tracker, which does not."""
    children = Path(f"/proc/{parent}/task/{parent}/children").read_text().split()
    return [
        int(each)
        for each in children
        if b"spawn_main" in Path(f"/proc/{each}/cmdline").read_bytes()
    ]


def finished_count(study):
    try:
        connection = sqlite3.connect(f"file:{study}/results.sqlite?mode=ro", uri=True)
    except sqlite3.OperationalError:
        return 0
    try:
        return connection.execute("SELECT count(*) FROM result").fetchone()[0]
    except sqlite3.OperationalError:
        return 0
    finally:
        connection.close()


@pytest.mark.slow
def test_a_sweep_killed_at_any_moment_loses_and_repeats_nothing(tmp_path, ncsim):
    options = {"scheduler.options.mood": ["slow"], "network.nodes": [2, 3, 4]}
    path = sweep_file(tmp_path, options, replicate={"seeds": 60})
    study, kept, moment = tmp_path / "study", {}, Random(5)
    for wanted in (0, 1, 40, 90):
        process = ncsim("sweep", path, "-o", study, "-j", 2)
        while finished_count(study) < wanted and process.poll() is None:
            time.sleep(0.02)
        time.sleep(moment.random() * 0.3)
        os.kill(process.pid, signal.SIGKILL)
        process.communicate(timeout=60)
        assert kept.items() <= finished(study).items()
        kept = finished(study)
    finish(ncsim("sweep", path, "-o", study, "-j", 2), 0)
    whole = tmp_path / "whole"
    finish(ncsim("sweep", path, "-o", whole, "-j", 2), 0)

    assert len(records(study)) == 180
    assert {row["status"] for row in records(study)} == {"completed"}
    assert kept.items() <= finished(study).items()  # wall times too: they were not done again
    assert timeless(study) == timeless(whole)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="finds workers under /proc")
def test_workers_killed_at_any_moment_lose_and_repeat_nothing(tmp_path, ncsim):
    options = {"scheduler.options.mood": ["slow"], "network.nodes": [2, 3, 4]}
    path = sweep_file(tmp_path, options, replicate={"seeds": 60})
    study, kept, moment = tmp_path / "study", {}, Random(6)
    process = ncsim("sweep", path, "-o", study, "-j", 2)
    for wanted in (1, 60):
        while finished_count(study) < wanted and process.poll() is None:
            time.sleep(0.02)
        time.sleep(moment.random() * 0.3)
        os.kill(moment.choice(workers_of(process.pid)), signal.SIGKILL)
        kept |= finished(study)
    finish(process, 0)

    assert len(records(study)) == 180
    assert {row["status"] for row in records(study)} == {"completed"}
    assert kept.items() <= finished(study).items()


def test_workers_leave_when_their_parent_is_killed(tmp_path, ncsim):
    path = sweep_file(tmp_path, {"scheduler.options.mood": ["slow"]}, replicate={"seeds": 500})
    process = ncsim("sweep", path, "-o", tmp_path / "study", "-j", 2)
    while finished_count(tmp_path / "study") < 1:
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.communicate(timeout=60)
    deadline = time.monotonic() + 20

    def is_left():
        try:
            os.killpg(process.pid, 0)
        except ProcessLookupError:
            return False
        return True

    while is_left() and time.monotonic() < deadline:
        time.sleep(0.1)
    assert not is_left()


def test_a_run_that_kills_its_worker_is_a_failed_row_and_the_others_are_done(tmp_path, ncsim):
    path = sweep_file(tmp_path, {"scheduler.options.mood": ["ok", "die", "raise", "slow"]})
    finish(ncsim("sweep", path, "-o", tmp_path / "study", "-j", 2), 2)
    rows = {row["scheduler.options.mood"]: row for row in records(tmp_path / "study")}

    assert {mood: row["status"] for mood, row in rows.items()} == {
        "ok": "completed",
        "die": "failed",
        "raise": "failed",
        "slow": "completed",
    }
    assert "worker died" in rows["die"]["error"]
    assert "no mood for work" in rows["raise"]["error"]
    assert rows["die"]["makespan_s"] is None


def test_a_hanging_run_ends_at_the_wall_limit_and_the_others_are_done(tmp_path, ncsim):
    moods = {"scheduler.options.mood": ["ok", "hang", "deaf", "slow"]}
    path = sweep_file(tmp_path, moods, limits={"wall_s": 1.0})
    finish(ncsim("sweep", path, "-o", tmp_path / "study", "-j", 2), 2)
    rows = {row["scheduler.options.mood"]: row for row in records(tmp_path / "study")}

    assert [rows[mood]["status"] for mood in ("ok", "slow")] == ["completed"] * 2
    assert rows["hang"]["status"] == "limit_reached"
    assert "wall limit of 1 s; it was in schedule (moody.py:" in rows["hang"]["error"]
    assert "within schedule of scheduler 'moody' (moody 1.0)" in rows["hang"]["error"]
    assert rows["deaf"]["status"] == "failed"
    assert "gave no answer within the wall limit of 1 s" in rows["deaf"]["error"]


def test_only_failed_runs_are_done_again_on_request(tmp_path, ncsim):
    path = sweep_file(tmp_path, {"scheduler.options.mood": ["ok", "raise"]})
    study = tmp_path / "study"
    finish(ncsim("sweep", path, "-o", study, "-j", 1), 2)
    before = records(study)
    finish(ncsim("sweep", path, "-o", study, "-j", 1), 2)
    assert records(study) == before
    (tmp_path / "site" / "moody.py").write_text(
        (tmp_path / "site" / "moody.py").read_text().replace("raise RuntimeError", "str")
    )
    finish(ncsim("sweep", path, "-o", study, "-j", 1, "--retry-failed"), 0)
    after = records(study)

    assert after[0] == before[0]
    assert after[1]["status"] == "completed"
    assert after[1]["error"] is None


needs_unshare = pytest.mark.skipif(
    shutil.which("unshare") is None
    or subprocess.run(
        ["unshare", "-rm", "sh", "-c", "mount -t tmpfs -o size=64k none /mnt"],
        check=False,
        capture_output=True,
    ).returncode
    != 0,
    reason="needs leave to mount a small file system in a namespace of its own",
)


@pytest.mark.slow
@needs_unshare
def test_a_full_disk_ends_the_sweep_and_keeps_what_was_done(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    path = tmp_path / "study.yaml"
    path.write_text(
        "sweep:\n  base:\n    network: {type: line, nodes: 2, bandwidth_MBps: 1}\n"
        "    dags: {type: chain, tasks: 2}\n    config: {scheduler: round_robin}\n"
        "  replicate: {seeds: 3000}\n"
    )
    ncsim = f"{sys.executable} -c 'from ncsim_core.cli.main import main; main()'"
    sweep = f"{ncsim} sweep {path} -o {disk}/study --executor serial"
    script = (
        f"mount -t tmpfs -o size=400k none {disk} && {{ {sweep}; echo code $?; }} && "
        f"{ncsim} sweep status {disk}/study; mount -o remount,size=20m {disk} && "
        f"{ncsim} sweep status {disk}/study && {sweep} && {ncsim} sweep status {disk}/study"
    )
    done = subprocess.run(
        ["unshare", "-rm", "sh", "-c", script],
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )

    assert "full" in done.stderr, done
    assert "code 1" in done.stdout
    assert "3000 runs, 3000 completed, 0 to do" in done.stdout


@needs_unshare
def test_a_study_that_may_only_be_read_is_reported(tmp_path, ncsim):
    path = sweep_file(tmp_path, {"scheduler.options.mood": ["ok"]})
    study = tmp_path / "study"
    finish(ncsim("sweep", path, "-o", study, "--executor", "serial"), 0)
    report = "from ncsim_core.cli.main import main; main(['report', '/mnt'])"
    script = (
        f"mount --bind {study} /mnt && mount -o remount,ro,bind /mnt && "
        f'exec {sys.executable} -c "{report}"'
    )
    done = subprocess.run(
        ["unshare", "-rm", "sh", "-c", script], capture_output=True, text=True, check=False
    )

    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[2].startswith("ok ")
