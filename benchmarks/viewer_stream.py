"""How far the server lags behind a run that writes 20,000 records a second, connections dropping.

Usage: python benchmarks/viewer_stream.py [seconds] [records per second], by default 10 and 20000. A
process writes a trace as ``ncsim run`` does, a server process streams it, and this one follows it
and hangs up once a second. Prints the lag at each arrival and checks every byte.
"""

import re
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import closing
from http.client import HTTPConnection
from pathlib import Path

from ncsim_core.engine.events import TASK_COMPLETE, TASK_READY
from ncsim_core.engine.observer import Batch
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.output import atomic_output_folder
from ncsim_core.trace.writer import TraceWriter


def now_us() -> int:
    """Return a time that all processes of a machine share."""
    return time.monotonic_ns() // 1000


LIMIT_s = 1.0
SLACK = 2
"""For shared machines."""
FIRST_us = now_us()
RUN = "live"
AT_A_TIME = 100


def write(folder: str, seconds: float, per_second: int) -> None:
    """Write records whose time is the clock's, at an even pace, then end the trace."""
    with (
        atomic_output_folder(Path(folder) / RUN) as output,
        TraceWriter(output / "trace.jsonl", is_live=True) as writer,
    ):
        simulation = worked_example(writer)
        simulation.step()
        started_s = time.monotonic()
        for first in range(0, int(seconds * per_second), AT_A_TIME):
            time.sleep(max(0.0, started_s + first / per_second - time.monotonic()))
            kinds = (TASK_READY, TASK_COMPLETE) * (AT_A_TIME // 2)
            writer.events_happened(Batch([(now_us(), kind, 0, 0) for kind in kinds], {}))
        simulation.run()


class Page:
    """Follows a run as a page does.

    Args:
        port: Of the server.
        token: Likewise.
    """

    def __init__(self, port: int, token: str) -> None:
        self._port = port
        self._token = token
        self._place = ""
        self.lines: list[bytes] = []
        self.lags_s: list[float] = []
        self.drops = 0

    def follow(self) -> None:
        """Take in the whole run, hanging up once a second."""
        while not self._connected():
            self.drops += 1

    def _connected(self) -> bool:
        """Take in what one connection brings; return whether the run has ended."""
        with closing(HTTPConnection("127.0.0.1", self._port, timeout=30)) as to:
            address = f"/api/stream?run={RUN}&from={self._place}"
            to.request("GET", address, headers={"X-Ncsim-Token": self._token})
            answer = to.getresponse()
            while answer.status != 200:  # not begun yet
                time.sleep(0.05)
                answer.read()
                to.request("GET", address, headers={"X-Ncsim-Token": self._token})
                answer = to.getresponse()
            hang_up_at_s = time.monotonic() + 1
            for raw in answer:
                if raw.startswith(b"event: end"):
                    return True
                self._take(raw)
                if raw == b"\n" and time.monotonic() > hang_up_at_s:
                    return False
        raise ConnectionError("the server hung up")

    def _take(self, raw: bytes) -> None:
        if raw.startswith(b"id: "):
            self._place = raw[4:-1].decode()
        elif raw.startswith(b"data: "):
            self.lines.append(raw[6:])
        elif raw == b"\n" and self.lines:
            match = re.match(rb'{"t":(\d+),"k":"(?:ready|end)"', self.lines[-1])
            if match and int(match[1]) >= FIRST_us:
                self.lags_s.append((now_us() - int(match[1])) / 1e6)


def main() -> None:
    """Measure, print and judge."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    per_second = int(sys.argv[2]) if len(sys.argv) > 2 else 20_000
    with tempfile.TemporaryDirectory() as folder:
        cli = "from ncsim_core.cli.main import main; main()"
        serve = [sys.executable, "-c", cli, "view", "--serve", folder, "--no-browser"]
        server = subprocess.Popen(serve, stdout=subprocess.PIPE, text=True)
        try:
            assert server.stdout is not None
            _, port, token = re.split(r".*:|/\?token=", server.stdout.readline().strip())
            page = Page(int(port), token)
            arguments = ["write", folder, str(seconds), str(per_second)]
            writer = subprocess.Popen([sys.executable, __file__, *arguments])
            page.follow()
            writer.wait()
            status = Path(f"/proc/{server.pid}/status").read_text()
        finally:
            server.terminate()
            server.wait()
        is_equal = b"".join(page.lines) == (Path(folder) / RUN / "trace.jsonl").read_bytes()
    memory = re.search(r"VmRSS:\s+(\d+)", status)
    print(f"{len(page.lines)} records at {per_second}/s, {page.drops} dropped connections")
    print(f"bytes equal those of the file: {is_equal}")
    print(f"lag: median {statistics.median(page.lags_s):.3f} s, most {max(page.lags_s):.3f} s")
    print(f"server: {int(memory[1]) / 1000 if memory else 0:.0f} MB resident")
    if not is_equal or max(page.lags_s) > SLACK * LIMIT_s:
        sys.exit("the page falls behind, or loses records")


if __name__ == "__main__":
    if sys.argv[1:2] == ["write"]:
        write(sys.argv[2], float(sys.argv[3]), int(sys.argv[4]))
    else:
        main()
