"""The viewer's server as users start it: runs of other terminals live, plug-ins, Ctrl-C."""

import json
import os
import re
import signal
import subprocess
import sys
import time
import tomllib
from contextlib import closing, contextmanager
from http.client import HTTPConnection
from pathlib import Path
from urllib.parse import quote

import pytest
from ncsim_core.testing.fixtures import write_dist

THIRD_PARTY = Path(__file__).parents[2] / "examples" / "third-party"
WIRELESS = """
scenario:
  name: wireless
  network:
    nodes:
      - {{id: a, compute_capacity: 1, position: {{x: 0, y: 0}}}}
      - {{id: b, compute_capacity: 2, position: {{x: 30, y: 0}}}}
    links: [{{id: ab, from: a, to: b}}, {{id: ba, from: b, to: a}}]
  dags: [{dags}]
  config: {{scheduler: round_robin, interference: csma_bianchi}}
"""


def scenario(dags):
    """Return a scenario whose run leaves some 30 records per DAG."""
    tasks = ", ".join(f"{{id: T{number}, compute_cost: 0.01}}" for number in range(6))
    edges = ", ".join(f"{{from: T{n}, to: T{n + 1}, data_size: 0.5}}" for n in range(5))
    rows = (
        f"{{id: d{n}, inject_at: {n}, tasks: [{tasks}], edges: [{edges}]}}" for n in range(dags)
    )
    return WIRELESS.format(dags=", ".join(rows))


def ncsim(*arguments, **options):
    listen = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    main = f"{listen}; from ncsim_core.cli.main import main; main()"  # a shell may ignore Ctrl-C
    command = [sys.executable, "-c", main, *map(str, arguments)]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options
    )


@contextmanager
def served(folder, **options):
    """Yield a server's process, port and token."""
    with ncsim(
        "view", "--serve", folder, "--no-browser", start_new_session=True, **options
    ) as process:
        try:
            url = process.stdout.readline()
            port, token = re.search(r"http://127\.0\.0\.1:(\d+)/\?token=(\S+)", url).groups()
            assert f"ssh -L {port}:127.0.0.1:{port}" in process.stdout.readline()
            yield process, int(port), token
        finally:
            process.terminate()


def ask(server, method, path, body=None):
    _, port, token = server
    with closing(HTTPConnection("127.0.0.1", port, timeout=60)) as to:
        headers = {"X-Ncsim-Token": token, "Content-Type": "application/json"}
        to.request(method, path, None if body is None else json.dumps(body), headers)
        answer = to.getresponse()
        return answer.status, json.loads(answer.read())


def followed(server, run, drop_after):
    """Return the bytes of a run as a page gets them whose connection drops again and again.

    Every other time it drops before what was sent is taken in, else right after.
    """
    _, port, token = server
    got, place, drops = b"", "", 0
    while True:
        with closing(HTTPConnection("127.0.0.1", port, timeout=60)) as to:
            address = f"/api/stream?run={quote(run)}&token={token}&from={place}"
            to.request("GET", address)
            answer = to.getresponse()
            if answer.status == 404:  # not begun yet
                time.sleep(0.02)
                continue
            for block in blocks(answer):
                if b"event: restart" in block or b"event: end" in block:
                    return got, drops, block
                lines = [line[6:] for line in block if line.startswith(b"data: ")]
                is_dropped = bool(lines) and drops < drop_after
                drops += is_dropped
                if is_dropped and drops % 2:
                    break
                got += b"".join(line + b"\n" for line in lines)
                place = next(
                    (line[4:].decode() for line in block if line.startswith(b"id: ")), place
                )
                if is_dropped:
                    break


def blocks(answer):
    """Yield the lines of each event."""
    lines = []
    for raw in answer:
        line = raw.rstrip(b"\n")
        if line:
            lines.append(line)
        elif lines:
            yield lines
            lines = []


def test_a_run_of_another_terminal_is_followed_across_dropped_connections(tmp_path):
    (tmp_path / "scenario.yaml").write_text(scenario(250))
    folder = tmp_path / "runs"
    folder.mkdir()
    with (
        served(folder) as server,
        ncsim("run", tmp_path / "scenario.yaml", "-o", folder / "x") as run,
    ):
        got, drops, end = followed(server, "x", drop_after=5)
        assert run.wait(60) == 0

    assert b'data: {"status": "completed"}' in end
    assert drops >= 3
    assert got == (folder / "x" / "trace.jsonl").read_bytes()


def child_of(server, folder):
    """Return the process of a long run that the server was asked for."""
    status, answer = ask(server, "POST", "/api/jobs", {"yaml": scenario(1000), "name": "long"})
    assert status == 200, answer
    while not (partial := list(folder.glob(".long.partial-*"))):
        time.sleep(0.02)
    return int(partial[0].name.split("-")[1])


def ends(process):
    """Return whether a process ends soon; a signal takes a moment."""
    status = Path(f"/proc/{process}/status")
    deadline_s = time.monotonic() + 10
    while status.exists() and "\nState:\tZ" not in status.read_text():
        if time.monotonic() > deadline_s:
            return False
        time.sleep(0.02)
    return True


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux ends children with their parent")
def test_a_server_that_is_killed_leaves_no_run_behind(tmp_path):
    with served(tmp_path) as server:
        child = child_of(server, tmp_path)
        server[0].kill()
        server[0].wait()

        assert ends(child)


def test_ctrl_c_ends_the_server_cleanly_with_all_that_it_started(tmp_path):
    with served(tmp_path) as server:
        process = server[0]
        child = child_of(server, tmp_path)
        with closing(HTTPConnection("127.0.0.1", server[1], timeout=60)) as stream:
            stream.request("GET", f"/api/stream?run=long&token={server[2]}")
            stream.getresponse().readline()
            process.send_signal(signal.SIGINT)
            _, complaint = process.communicate(timeout=60)

        assert (process.returncode, complaint) == (0, "")
        assert ends(child)
        assert list(tmp_path.iterdir()) == []


@pytest.fixture
def third_party(tmp_path):
    """Return the environment of a process that finds the example plug-in installed."""
    project = tomllib.loads((THIRD_PARTY / "pyproject.toml").read_text())["project"]
    name, points = project["name"], project["entry-points"]["ncsim.plugins"]
    site = tmp_path / "site"
    write_dist(site, name, {}, version=project["version"], entry_points=points)
    paths = map(str, (site, THIRD_PARTY / "src"))
    return name, {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}


def test_options_of_a_third_party_plug_in_appear_and_are_checked(tmp_path, third_party):
    name, environment = third_party
    with served(tmp_path, env=environment) as server:
        kinds = ask(server, "GET", "/api/catalogue")[1]["kinds"]
        schedulers = next(kind for kind in kinds if kind["kind"] == "scheduler")["components"]
        component = next(each for each in schedulers if each["distribution"] == name)
        (option,) = component["options"]["properties"]
        schema = json.dumps(ask(server, "GET", "/api/schema")[1])
        wrong = f"{{type: {component['name']}, options: {{{option}: []}}}}"
        text = scenario(1).replace("scheduler: round_robin", f"scheduler: {wrong}")
        faults = ask(server, "POST", "/api/validate", {"yaml": text})[1]["faults"]
        right = scenario(1).replace("round_robin", component["name"])
        resolved = ask(server, "POST", "/api/validate", {"yaml": right})[1]["resolved"]

    assert f'"{option}"' in schema
    assert [each["pointer"] for each in faults] == [f"/scenario/config/scheduler/options/{option}"]
    assert option in resolved["scenario"]["config"]["scheduler"]["options"]
