"""A run followed while it is written, over connections that drop."""

import contextlib
import json
import os
import shutil
import socket
import threading

import pytest
from ncsim_viz.server.child import Limits
from ncsim_viz.server.serving import ViewerServer


class Wire:
    """A way to a server that can be cut; who connects again is let through."""

    def __init__(self, port):
        self.target = port
        self.ends = []
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        with contextlib.suppress(OSError):
            while True:
                near, _ = self.listener.accept()
                far = socket.create_connection(("127.0.0.1", self.target))
                self.ends += [near, far]
                for source, target in ((near, far), (far, near)):
                    threading.Thread(target=self._pump, args=(source, target), daemon=True).start()

    def _pump(self, source, target):
        with contextlib.suppress(OSError):
            while data := source.recv(65536):
                target.sendall(data)
        for end in (source, target):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)

    def cut(self):
        ends, self.ends = self.ends, []
        for end in ends:
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()

    def close(self):
        self.listener.close()
        self.cut()


@pytest.fixture
def served(tmp_path):
    root = tmp_path / "served"
    root.mkdir()
    with ViewerServer(root, limits=Limits(60.0, 4000, 100)) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        wire = Wire(server.port)
        yield server, wire
        wire.close()
        server.shutdown()
        thread.join()


@pytest.fixture
def live_trace(served):
    """The trace of a run that goes on: this process writes it."""
    folder = served[0].site.library.root / f".live.partial-{os.getpid()}-0123abcd"
    folder.mkdir()
    return folder / "trace.jsonl"


def append(path, lines):
    with path.open("a") as file:
        file.write("".join(line + "\n" for line in lines))


def test_a_run_is_followed_over_dropped_connections_and_nothing_is_lost_or_repeated(
    served, live_trace, grid_runs, open_page, until
):
    server, wire = served
    lines = (grid_runs[0] / "trace.jsonl").read_text().splitlines()
    append(live_trace, lines[:20])
    address = server.url.replace(str(server.port), str(wire.port))
    page = open_page(address)
    page.get_by_role("button", name="live", exact=True).click()
    until(page, "ncsimViewer.run.lines === 20")

    assert page.locator("header .status").inner_text() == "live"
    for first in range(20, len(lines), 15):
        wire.cut()
        append(live_trace, lines[first : first + 15])
        count = min(first + 15, len(lines))
        until(page, f"ncsimViewer.run.lines >= {count}")
        assert page.evaluate("ncsimViewer.run.lines") == count
    final = live_trace.parent.with_name("live")
    shutil.move(live_trace.parent, final)
    until(page, "!ncsimViewer.run.isLive && ncsimViewer.page.source.extras.metrics !== undefined")

    shown = page.evaluate(
        "() => { const r = ncsimViewer.run; return {events: r.events, at: [...r.evLine.view()],"
        " end: r.end, makespan: r.done.makespan, rates: [...r.stRate.view()]}; }"
    )
    records = [json.loads(line) for line in lines[1:]]
    assert shown["at"] == list(range(2, len(lines) + 1))
    assert shown["makespan"] == records[-1]["makespan_us"]
    assert shown["rates"] == [rate for record in records for rate in record.get("r", [])]
    assert page.evaluate("ncsimViewer.state().event") == len(records) - 1  # the playhead followed


def test_a_playhead_that_was_moved_stays_while_the_run_goes_on(
    served, live_trace, grid_runs, open_page, until
):
    server, _ = served
    lines = (grid_runs[0] / "trace.jsonl").read_text().splitlines()
    append(live_trace, lines[:40])
    page = open_page(server.url + "#v=gantt&p=live")
    until(page, "ncsimViewer.run.lines === 40")
    page.evaluate("ncsimViewer.goTo(10)")
    append(live_trace, lines[40:80])
    until(page, "ncsimViewer.run.lines === 80")
    page.wait_for_timeout(300)

    assert page.evaluate("ncsimViewer.state().event") == 10


def test_a_run_that_is_made_anew_takes_the_place_of_the_old_one(
    served, live_trace, grid_runs, open_page, until
):
    server, _ = served
    lines = (grid_runs[0] / "trace.jsonl").read_text().splitlines()
    append(live_trace, lines[:50])
    page = open_page(server.url + "#v=gantt&p=live")
    until(page, "ncsimViewer.run.lines === 50")
    live_trace.unlink()
    header = json.loads(lines[0]) | {"scenario": "another"}
    append(live_trace, [json.dumps(header), *lines[1:8]])

    until(page, "ncsimViewer.run.lines === 8 && ncsimViewer.run.header.scenario === 'another'")
    assert page.locator("h1").inner_text() == "another"
