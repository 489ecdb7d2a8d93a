"""Where runs are carried out: by name, by entry point, in parts."""

import io
import json
from contextlib import redirect_stderr, redirect_stdout

import pytest
import yaml
from ncsim_core.cli.main import main
from ncsim_core.cli.progress import Pace
from ncsim_core.errors import ScenarioError
from ncsim_core.sweep import dispatch
from ncsim_core.sweep.executors import executor_factory
from ncsim_core.sweep.running import run_sweep
from ncsim_core.sweep.store import Store
from ncsim_core.sweep.table import table_of
from ncsim_core.testing.fixtures import fake_dist

__all__ = ["fake_dist"]

SWEEP = {
    "sweep": {
        "name": "parts",
        "base": {
            "network": {"type": "line", "nodes": 3, "bandwidth_MBps": 1},
            "dags": {"type": "layered_random", "layers": 3, "width": 2},
            "config": {"scheduler": "round_robin", "routing": "minimum_hop"},
        },
        "vary": {"network.nodes": [3, 4]},
        "replicate": {"seeds": 7},
    }
}
THREADS = """
from concurrent.futures import ThreadPoolExecutor

ASKED = []


def threads(request):
    ASKED.append(request)
    return ThreadPoolExecutor(request.workers)
"""
BREAKING = """
from concurrent.futures import BrokenExecutor, Executor, Future

MADE = []


class Breaking(Executor):
    \"\"\"The first one takes two chunks, does neither, and takes no third.\"\"\"

    workers = 4

    def __init__(self, request):
        MADE.append(self)
        self._is_first = len(MADE) == 1
        self._taken = 0

    def submit(self, fn, /, *args, **more):
        self._taken += 1
        future = Future()
        if not self._is_first:
            future.set_result(fn(*args, **more))
        elif self._taken > 2:
            raise BrokenExecutor("no more")
        return future
"""
DESERTED = """
from concurrent.futures import Executor, Future


class Deserted(Executor):
    \"\"\"Does one chunk, then nobody is left.\"\"\"

    def __init__(self, request):
        self._is_left = True

    def submit(self, fn, /, *args, **more):
        future = Future()
        if self._is_left:
            future.set_result(fn(*args, **more))
        self._is_left = False
        return future

    def trouble(self):
        return None if self._is_left else "all have left"
"""


def ncsim(*args):
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as stop:
        main([str(each) for each in args])
    return stop.value.code, out.getvalue(), err.getvalue()


def timeless(study):
    with Store(study, must_exist=True) as store:
        return [{k: v for k, v in r.items() if k != "wall_s"} for r in table_of(store).to_dicts()]


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "parts.yaml"
    file.write_text(yaml.safe_dump(SWEEP))
    return file


@pytest.fixture
def whole(path, tmp_path):
    with run_sweep(path, tmp_path / "whole", executor="serial") as results:
        results.table()
    return timeless(tmp_path / "whole")


def test_a_package_offers_an_executor_through_an_entry_point(fake_dist, path, tmp_path, whole):
    folder = fake_dist("my-pool", {"my_pool": THREADS}, entry_points={})
    info = folder / "my_pool-1.0.dist-info" / "entry_points.txt"
    info.write_text("[ncsim.executors]\nthreads = my_pool:threads\n")
    from my_pool import ASKED

    code, _, err = ncsim("sweep", path, "-o", tmp_path / "study", "--executor", "threads", "-j", 3)

    assert (code, err) == (0, "")
    assert [each.workers for each in ASKED] == [3]
    assert timeless(tmp_path / "study") == whole


def test_runs_in_flight_when_an_executor_takes_no_more_are_done_by_the_next(
    fake_dist, path, tmp_path, whole
):
    folder = fake_dist("my-pool", {"my_pool": BREAKING}, entry_points={})
    info = folder / "my_pool-1.0.dist-info" / "entry_points.txt"
    info.write_text("[ncsim.executors]\nbreaking = my_pool:Breaking\n")
    options = ("--executor", "breaking", "-j", 4)

    assert ncsim("sweep", path, "-o", tmp_path / "study", *options)[0] == 0
    assert timeless(tmp_path / "study") == whole


def test_an_executor_that_nobody_offers_is_told_before_anything_runs(path, tmp_path):
    with pytest.raises(ScenarioError, match="no executor 'slurm'; there are process, serial, dask"):
        executor_factory("slurm")

    assert ncsim("sweep", path, "-o", tmp_path / "study", "--executor", "slurm")[0] == 1


def test_shards_of_a_job_array_merge_into_the_whole(path, tmp_path, whole):
    parts = [tmp_path / f"part-{number}" for number in (1, 2, 3)]
    for number, part in enumerate(parts, start=1):
        options = ("-o", part, "--executor", "serial", "--shard", f"{number}/3")
        assert ncsim("sweep", path, *options)[0] == 0
    code, out, _ = ncsim("sweep", "merge", tmp_path / "study", *parts[:2], "--json")

    assert code == 0
    assert json.loads(out)["to_do"] == 4  # runs 3, 6, 9, 12 of 14
    assert ncsim("sweep", "merge", tmp_path / "study", *parts)[1].endswith(
        "14 completed, 0 to do\n"
    )
    assert timeless(tmp_path / "study") == whole


@pytest.mark.parametrize("shard", ["0/3", "4/3", "1", "a/b", "1/0"])
def test_impossible_shards_are_refused(path, tmp_path, shard):
    code, _, err = ncsim("sweep", path, "-o", tmp_path / "study", "--shard", shard)

    assert code == 1
    assert "shard" in err


def test_merging_what_is_no_study_leaves_nothing_behind(tmp_path):
    code, _, err = ncsim("sweep", "merge", tmp_path / "study", tmp_path / "nothing")

    assert code == 1
    assert "is it the folder of a sweep?" in err
    assert not (tmp_path / "study").exists()


def test_status_says_why_runs_did_not_complete(tmp_path):
    sweep = {"sweep": {**SWEEP["sweep"], "limits": {"max_events": 3}}}
    file = tmp_path / "short.yaml"
    file.write_text(yaml.safe_dump(sweep))
    code, _, err = ncsim("sweep", file, "-o", tmp_path / "study", "--executor", "serial")
    status = ncsim("sweep", "status", tmp_path / "study")[1]

    assert code == 2
    assert "says why" in err
    assert status.splitlines() == [
        "parts: 14 runs, 14 limit_reached, 0 to do",
        "  14 limit_reached: the limit of 3 events",
    ]


def test_a_limit_that_was_raised_is_tried_again_on_request(tmp_path):
    def done(max_events, **options):
        sweep = {"sweep": {**SWEEP["sweep"], "limits": {"max_events": max_events}}}
        with run_sweep(sweep, tmp_path / "study", executor="serial", **options) as results:
            return {row["status"] for row in results.table().to_dicts()}

    assert done(3) == {"limit_reached"}
    assert done(10_000) == {"limit_reached"}
    assert done(10_000, retry_failed=True) == {"completed"}


def test_an_executor_that_has_nobody_left_ends_the_sweep_and_what_was_done_is_kept(
    fake_dist, path, tmp_path, monkeypatch
):
    monkeypatch.setattr(dispatch, "LOOK_EVERY_s", 0.01)
    folder = fake_dist("my-pool", {"my_pool": DESERTED}, entry_points={})
    info = folder / "my_pool-1.0.dist-info" / "entry_points.txt"
    info.write_text("[ncsim.executors]\ndeserted = my_pool:Deserted\n")
    code, _, err = ncsim("sweep", path, "-o", tmp_path / "study", "--executor", "deserted")

    assert code == 1
    assert "all have left; what is done is kept, run the same command again" in err
    assert ncsim("sweep", "status", tmp_path / "study")[1] == (
        "parts: 14 runs, 4 completed, 10 to do\n"
    )


def test_the_pace_forgets_results_that_were_there_already():
    now_s = [0.0]
    pace = Pace(lambda: now_s[0])
    for second in range(1, 31):  # 1000 at once, then two per second
        now_s[0] = float(second)
        rate = pace.at(1000 + 2 * second)

    assert rate == pytest.approx(2.0)
