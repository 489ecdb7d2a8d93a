import subprocess
import time

import pytest
from ncsim_core.trace.loading import load_run
from ncsim_viz.server.child import Limits
from ncsim_viz.server.processes import LimitedProcess

LONG = """
scenario:
  name: long one/../x
  network: {{nodes: [{{id: a, compute_capacity: 1}}]}}
  dags:
    - id: d
      tasks: [{tasks}]
  config: {{scheduler: round_robin, link_model: static}}
"""


def long_scenario(tasks=2000):
    """Return a scenario of many tasks."""
    rows = ", ".join(f"{{id: t{number}, compute_cost: 1}}" for number in range(tasks))
    return LONG.format(tasks=rows)


GREEDY = """
import sys
import time

def memory():
    bytearray(10**9)

def output():
    with open(sys.argv[4] + ".big", "wb") as file:
        file.write(bytes(2_000_000))

def wall():
    time.sleep(60)

def slowly():
    from ncsim_core.cli.main import main
    from ncsim_core.trace.writer import TraceWriter

    events_happened = TraceWriter.events_happened

    def slow(writer, batch):
        events_happened(writer, batch)
        time.sleep(0.002 * len(batch.events))

    TraceWriter.events_happened = slow
    main()

def quiet():
    raise SystemExit(1)
"""


@pytest.fixture
def greedy(tmp_path, monkeypatch):
    """Return a function that puts something else in the place of a run."""

    def install(name):
        (tmp_path / "greedy.py").write_text(GREEDY)
        monkeypatch.setenv("PYTHONPATH", str(tmp_path))
        monkeypatch.setattr("ncsim_viz.server.jobs.ENTRY", f"greedy:{name}")

    return install


def until(client, job, states, within_s=60):
    """Return a job when it is in one of some states."""
    deadline = time.monotonic() + within_s
    while time.monotonic() < deadline:
        jobs = {each["id"]: each for each in client.get("/api/jobs")[1]["jobs"]}
        if jobs[job]["state"] in states:
            return jobs[job]
        time.sleep(0.05)
    raise AssertionError(jobs[job])


def is_running(process):
    """Return whether a process is there and no zombie."""
    ask = ["ps", "-o", "stat=", str(process)]
    state = subprocess.run(ask, check=False, capture_output=True, text=True).stdout.strip()
    return bool(state) and not state.startswith("Z")


def start(client, yaml, name="new"):
    status, answer = client.post("/api/jobs", {"yaml": yaml, "name": name})
    assert status == 200, answer
    return answer["job"]


def test_a_run_from_the_page_leaves_what_the_command_line_leaves(client, run_folder, scenario_text):
    job = start(client, scenario_text, "small")

    ended = until(client, job["id"], {"ended", "failed"})
    assert (ended["state"], ended["status"], ended["message"]) == ("ended", "completed", "")
    assert ended["run"] == "small-2"  # the name was taken
    assert ended["progress"]["tasks_ended"] == ended["progress"]["tasks"] == 2
    made = run_folder.parent / "small-2"
    assert {each.name for each in made.iterdir()} == {
        "trace.jsonl", "metrics.json", "run.json", "scenario.yaml",
    }  # fmt: skip
    assert load_run(made).tasks == load_run(run_folder).tasks
    assert client.get("/api/extras", run="small-2")[0] == 200


def test_a_wrong_scenario_is_not_queued(client, scenario_text):
    wrong = scenario_text.replace("manual", "manuel")
    status, answer = client.post("/api/jobs", {"yaml": wrong})

    assert status == 400
    assert answer["faults"][0]["pointer"] == "/scenario/config/scheduler"
    assert client.get("/api/jobs")[1]["jobs"] == []


def test_runs_wait_for_each_other_show_progress_and_can_be_cancelled(client, run_folder, greedy):
    greedy("slowly")
    first = start(client, long_scenario(), "../first one")
    second = start(client, long_scenario())
    running = until(client, first["id"], {"running"})
    while running["progress"] is None or running["progress"]["simulated_s"] == 0:
        running = until(client, first["id"], {"running"})
    live = {each["id"]: each for each in client.get("/api/entries")[1]["entries"]}[first["run"]]
    waiting = until(client, second["id"], {"queued"})

    assert first["run"] == "first-one"
    assert (live["is_live"], live["status"]) == (True, "running")
    assert 0 < running["progress"]["tasks_ended"] <= running["progress"]["tasks"] == 2000
    assert waiting["ran_s"] is None
    assert client.post("/api/jobs/cancel", {"job": second["id"]})[1]["job"]["state"] == "cancelled"
    assert client.post("/api/jobs/cancel", {"job": first["id"]})[0] == 200
    assert until(client, first["id"], {"cancelled"})["status"] is None
    assert client.post("/api/jobs/cancel", {"job": first["id"]})[0] == 409
    assert client.post("/api/jobs/cancel", {"job": "99"})[0] == 404
    assert [each.name for each in run_folder.parent.iterdir()] == ["small"]


def test_a_queue_has_an_end(client, monkeypatch, scenario_text):
    monkeypatch.setattr("ncsim_viz.server.jobs.MAX_WAITING", 0)

    assert client.post("/api/jobs", {"yaml": scenario_text})[0] == 429


@pytest.mark.parametrize(
    ("entry", "limits", "why"),
    [
        ("wall", Limits(wall_s=0.5), "stopped after 0.5 s, the limit of ncsim view --max-wall"),
        ("memory", Limits(memory_MB=500), "needs more than 500 MB"),
        ("output", Limits(output_MB=1), "File too large"),
        ("quiet", Limits(), "ended with code 1 and said nothing"),
    ],
)
def test_a_run_that_takes_too_much_is_stopped_and_says_why(
    client, greedy, scenario_text, entry, limits, why
):
    greedy(entry)
    client.server.site.jobs.limits = limits

    failed = until(client, start(client, scenario_text)["id"], {"failed", "ended"})

    assert failed["state"] == "failed"
    assert why in failed["message"]


def test_a_process_that_ignores_an_interrupt_is_killed(monkeypatch, tmp_path):
    monkeypatch.setattr("ncsim_viz.server.processes.GRACE_s", 0.2)
    (tmp_path / "stubborn.py").write_text(
        "import signal, time\n"
        "def main():\n"
        "    signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
        "    time.sleep(60)\n"
    )
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    process = LimitedProcess(Limits(wall_s=0.5), "stubborn:main")

    assert process.wait() < 0
    assert process.interrupted == "out of time"
    process.close()


def test_what_a_process_started_ends_with_it(monkeypatch, tmp_path):
    (tmp_path / "parent.py").write_text(
        "import subprocess, sys, time\n"
        "def main():\n"
        "    child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(60)'])\n"
        "    print(child.pid, flush=True)\n"
        "    time.sleep(60)\n"
    )
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    process = LimitedProcess(Limits(), "parent:main")
    while not process.answer():
        time.sleep(0.02)
    child = int(process.answer())

    process.close()

    deadline_s = time.monotonic() + 10
    while is_running(child) and time.monotonic() < deadline_s:
        time.sleep(0.02)
    assert not is_running(child)
