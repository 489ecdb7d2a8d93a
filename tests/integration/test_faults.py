"""What goes wrong around a run: disks, folders, signals, plug-ins that never come back."""

import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from ncsim_core.trace.check import check_trace

TWO_HOP = Path(__file__).parents[2] / "examples" / "two_hop.yaml"
GRID = Path(__file__).parents[2] / "examples" / "grid_4x4.yaml"

NCSIM = "import sys; from ncsim_core.cli.main import main; main(sys.argv[1:])"
PLANT = """
import importlib, sys
module, kind, method = sys.argv[1].split(":")
def endless(*_, **__):
    while True:
        pass
def hungry(*_, **__):
    eaten = []
    while True:
        eaten.append(bytearray(10_000_000))
def removing(self, dag, snapshot):
    import shutil
    shutil.rmtree(sys.argv[3])
    return before(self, dag, snapshot)
where = getattr(importlib.import_module(module), kind)
before = getattr(where, method)
setattr(where, method, globals()[sys.argv[2]])
from ncsim_core.cli.main import main
main(sys.argv[4:])
"""
SCENARIO = """
scenario:
  network:
    nodes: [{id: a, compute_capacity: 1}, {id: b, compute_capacity: 1}]
    links: [{id: ab, from: a, to: b, bandwidth: 1}]
  dags:
    - id: d
      tasks:
        - {id: x, compute_cost: 1, pinned_to: a}
        - {id: y, compute_cost: 1, pinned_to: b}
        - {id: z, compute_cost: 1, pinned_to: a}
      edges: [{from: x, to: y, data_size: 1}]
  config: {scheduler: round_robin, routing: direct, interference: none}
"""
SCHEDULE = "ncsim_core.builtin.schedulers:RoundRobinScheduler:schedule"
POP = "ncsim_core.builtin.queue_models:FifoQueue:pop"
METHODS = [
    SCHEDULE,
    "ncsim_core.builtin.routing_models:DirectRouting:route",
    "ncsim_core.builtin.link_models:StaticLinkModel:rate_links",
    "ncsim_core.builtin.queue_models:FifoQueue:push",
    POP,
    "ncsim_core.builtin.dag_sources:MultiDAGSource:injections",
]
INTERFERENCE = "ncsim_wifi.interference_models.proximity:ProximityModel:"


@pytest.fixture
def scenario(tmp_path):
    path = tmp_path / "scenario.yaml"
    path.write_text(SCENARIO, encoding="utf-8")
    return path


def ncsim(*arguments, **settings):
    return subprocess.run(
        [sys.executable, "-c", NCSIM, *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        **settings,
    )


def planted(method, misdeed, folder, *arguments):
    return subprocess.run(
        [sys.executable, "-c", PLANT, method, misdeed, str(folder), *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )


def expect_no_traceback(done):
    assert "Traceback" not in done.stderr
    assert "internal error" not in done.stderr


@pytest.mark.parametrize("method", METHODS)
def test_a_plugin_that_never_returns_is_stopped_by_the_clock_and_named(method, scenario, tmp_path):
    done = planted(method, "endless", tmp_path, "run", scenario, "--max-wall", "0.2")

    expect_no_traceback(done)
    assert done.returncode in (1, 2)  # 1 where the run had not begun
    said = done.stdout + done.stderr
    assert "the limit of 0.2 s on the clock; it was in endless" in said
    kind = method.partition(":")[0].rpartition(".")[2].removesuffix("s")
    assert re.search(rf"\), within (\w+ of )?{kind} '\w+' \(ncsim-core ", said)


@pytest.mark.parametrize("method", METHODS)
def test_a_plugin_that_eats_memory_is_stopped_and_named(method, scenario, tmp_path):
    done = planted(method, "hungry", tmp_path, "run", scenario, "--max-memory", "300")

    expect_no_traceback(done)
    assert done.returncode in (1, 2)
    assert "raised MemoryError" in done.stdout + done.stderr


@pytest.mark.parametrize("method", ["factors", "reach", "competition"])
@pytest.mark.parametrize(
    ("misdeed", "limit", "says"),
    [
        ("endless", ("--max-wall", 4), "the limit of 4 s on the clock; it was in endless"),
        ("hungry", ("--max-memory", 300), "raised MemoryError"),
    ],
)
def test_an_interference_model_that_takes_all_is_stopped_and_named(
    method, misdeed, limit, says, scenario, tmp_path
):
    text = scenario.read_text(encoding="utf-8").replace(
        "interference: none", "interference: proximity"
    )
    for node in "ab":
        text = text.replace(
            f"id: {node}, compute", f"id: {node}, position: {{x: 0, y: 0}}, compute"
        )
    scenario.write_text(text, encoding="utf-8")

    done = planted(
        INTERFERENCE + method, misdeed, tmp_path, "run", scenario, "-o", tmp_path / "out", *limit
    )

    expect_no_traceback(done)
    assert done.returncode == 2
    assert says in done.stdout + done.stderr


def test_a_sweep_goes_on_after_a_run_that_eats_memory(tmp_path):
    text = sweep_of(tmp_path).read_text(encoding="utf-8").replace("seeds: 50", "seeds: 2")
    path = tmp_path / "limited.yaml"
    path.write_text(f"{text}  limits: {{memory_MB: 200}}\n", encoding="utf-8")
    study = tmp_path / "study"
    verb = ["sweep", path, "-o", study, "--executor", "serial"]

    done = planted(SCHEDULE, "hungry", tmp_path, *verb)

    expect_no_traceback(done)
    assert done.returncode == 2
    assert "2 failed" in done.stdout + done.stderr


def test_what_was_done_until_the_clock_stopped_it_is_kept(scenario, tmp_path):
    out = tmp_path / "out"

    done = planted(POP, "endless", tmp_path, "run", scenario, "-o", out, "--max-wall", "0.2")

    assert done.returncode == 2
    assert json.loads((out / "run.json").read_text("utf-8"))["status"] == "limit_reached"
    last = (out / "trace.jsonl").read_text("utf-8").splitlines()[-1]
    assert json.loads(last)["k"] == "done"


def test_a_run_that_ends_in_time_is_not_touched_by_limits(scenario):
    plain = ncsim("run", scenario, "--json")
    limited = ncsim("run", scenario, "--json", "--max-wall", 60, "--max-memory", 2000)

    assert plain.returncode == limited.returncode == 0
    assert plain.stdout == limited.stdout


@pytest.mark.parametrize("option", ["--max-time", "--max-wall", "--max-memory"])
@pytest.mark.parametrize("value", ["nan", "inf"])
def test_a_limit_that_is_no_number_is_refused_and_not_passed_over(option, value, scenario):
    done = ncsim("run", scenario, option, value)

    assert done.returncode == 1
    assert f"{option} {value}: must be finite" in done.stderr


def test_limits_beyond_what_a_system_knows_are_no_limits(scenario):
    done = ncsim("run", scenario, "--max-time", 1e300, "--max-wall", 1e300, "--max-memory", 1e300)

    assert done.returncode == 0, done.stderr


def test_an_output_folder_that_is_removed_during_a_run_is_told(scenario, tmp_path):
    parent = tmp_path / "parent"
    parent.mkdir()

    done = planted(SCHEDULE, "removing", parent, "run", scenario, "-o", parent / "out")

    expect_no_traceback(done)
    assert done.returncode == 1
    assert str(parent) in done.stderr


def test_a_file_in_the_way_of_the_output_is_told(scenario, tmp_path):
    (tmp_path / "taken").write_text("mine", encoding="utf-8")

    done = ncsim("run", scenario, "-o", tmp_path / "taken" / "out")

    expect_no_traceback(done)
    assert done.returncode == 1
    assert "taken" in done.stderr


@pytest.mark.skipif(os.geteuid() == 0, reason="root writes into read-only folders")
def test_a_read_only_folder_is_told(scenario, tmp_path):
    folder = tmp_path / "closed"
    folder.mkdir(mode=0o500)

    done = ncsim("run", scenario, "-o", folder / "out")

    expect_no_traceback(done)
    assert done.returncode == 1
    assert "cannot be written" in done.stderr


def few_bytes():
    resource.setrlimit(resource.RLIMIT_FSIZE, (1500, 1500))


def expect_nothing_left(done, folder):
    expect_no_traceback(done)
    assert done.returncode == 1
    assert done.stderr.strip()
    assert not [each for each in folder.iterdir() if not each.name.startswith("scenario")]


@pytest.mark.parametrize("options", [[], ["--gzip"], ["--trace", "off"]], ids=" ".join)
def test_a_file_that_may_not_grow_leaves_nothing_behind(options, scenario, tmp_path):
    done = ncsim("run", TWO_HOP, "-o", tmp_path / "out", *options, preexec_fn=few_bytes)

    expect_nothing_left(done, tmp_path)


@pytest.fixture
def tiny_disk(tmp_path):
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", str(folder)]
    is_there = shutil.which("mount") is not None
    if not is_there or subprocess.run(mount, check=False, capture_output=True).returncode:
        pytest.skip("no small file system can be mounted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


@pytest.mark.parametrize("form", ["run", "sweep", "export"])
def test_a_full_disk_is_told_and_leaves_nothing_under_a_final_name(form, tiny_disk, tmp_path):
    verb = {
        "run": ["run", GRID, "-o", tiny_disk / "out"],
        "sweep": ["sweep", sweep_of(tmp_path), "-o", tiny_disk / "study", "--executor", "serial"],
        "export": ["export", tmp_path / "run", "--to", "perfetto", "-o", tiny_disk / "out"],
    }[form]
    if form == "export":
        assert ncsim("run", GRID, "-o", tmp_path / "run").returncode == 0

    done = ncsim(*verb)

    expect_no_traceback(done)
    assert done.returncode == 1, done.stdout + done.stderr
    assert done.stderr.strip()
    assert not (tiny_disk / "out").exists()


def sweep_of(folder):
    path = folder / "sweep.yaml"
    path.write_text(
        "sweep:\n  base:\n"
        "    network: {type: line, nodes: 3}\n    dags: {type: chain, tasks: 4}\n"
        "    config: {scheduler: round_robin, link_model: wifi, routing: minimum_hop}\n"
        "  replicate: {seeds: 50}\n",
        encoding="utf-8",
    )
    return path


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGKILL, signal.SIGTERM])
def test_a_signal_at_any_moment_leaves_a_whole_run_or_none(sent, tmp_path):
    chance = random.Random(int(sent))
    started_s = time.monotonic()
    assert ncsim("run", GRID, "-o", tmp_path / "whole").returncode == 0
    took_s = time.monotonic() - started_s
    expected = (tmp_path / "whole" / "trace.jsonl").read_bytes()

    for number in range(4):
        out = tmp_path / f"out{number}"
        child = subprocess.Popen(
            [sys.executable, "-c", NCSIM, "run", str(GRID), "-o", str(out)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        )
        time.sleep(chance.uniform(0.3, 1.0) * took_s)
        child.send_signal(sent)
        _, complaint = child.communicate(timeout=120)
        if out.exists():
            assert (out / "trace.jsonl").read_bytes() == expected
            assert not list(check_trace(out / "trace.jsonl"))
            assert (out / "run.json").exists()
        else:
            assert child.returncode != 0
        if sent == signal.SIGINT and child.returncode == 130:
            assert b"interrupted; nothing was written" in complaint
            assert not list(tmp_path.glob(f".{out.name}.*"))
