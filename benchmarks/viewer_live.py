"""How far a page lags behind a run that writes 20,000 records a second.

Usage: python benchmarks/viewer_live.py [seconds]. Needs chromium and playwright. The server, the
writer and the browser are processes of their own. Each record carries the wall time of its writing
in milliseconds; the page compares it with its clock every 50 ms. Fails above 2 s (the specified
second, with slack for shared machines), or if a record is missing or comes twice.
"""

import json
import multiprocessing
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from playwright.sync_api import sync_playwright
from viewer import FLAGS, header, neighbours

RECORDS_per_s = 20_000
BATCH = 1000
NODES = 200
LAG_ms = 1000.0
SLACK = 2.0
SAMPLE = """() => { window.lags = []; window.timer = setInterval(() => {
if (ncsimViewer.run.events > 2) lags.push(Date.now() - ncsimViewer.run.end); }, 50); }"""


def write_run(folder: Path, seconds: float) -> None:
    """Write a trace at a steady pace: tasks that become ready, start and end, node after node."""
    tasks = int(RECORDS_per_s * seconds) // 3
    now_ms = time.time_ns() // 1_000_000
    inject = {"t": now_ms, "k": "inject", "d": 0, "dag": "d", "i0": 0, "x0": 0, "edges": []}
    inject["tasks"] = [[f"T{i}", 1.0] for i in range(tasks)]
    place = {"t": now_ms, "k": "place", "d": 0, "n": [i % NODES for i in range(tasks)]}
    partial = folder / f".live.partial-{os.getpid()}-0123abcd"
    partial.mkdir()
    with (partial / "trace.jsonl").open("w") as file:
        for record in (header("live", NODES, neighbours(NODES)), inject, place):
            file.write(json.dumps(record) + "\n")
        file.flush()
        time.sleep(4)
        begun_s = time.monotonic()
        for batch in range(3 * tasks // BATCH):
            now_ms = time.time_ns() // 1_000_000
            for at in range(batch * BATCH, (batch + 1) * BATCH):
                task, kind = at // 3, ("ready", "start", "end")[at % 3]
                file.write(f'{{"t":{now_ms},"k":"{kind}","i":{task},"n":{task % NODES}}}\n')
            file.flush()
            due_s = begun_s + (batch + 1) * BATCH / RECORDS_per_s
            time.sleep(max(0.0, due_s - time.monotonic()))
        print(f"wrote {3 * tasks // BATCH * BATCH / (time.monotonic() - begun_s):.0f} records/s")
        file.flush()
        time.sleep(3)


def main() -> None:
    """Print the lag, and fail above the limit."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    expected = 3 + 3 * (int(RECORDS_per_s * seconds) // 3) // BATCH * BATCH
    ncsim = Path(sys.executable).with_name("ncsim")
    with tempfile.TemporaryDirectory() as name, sync_playwright() as playwright:
        server = subprocess.Popen(
            [ncsim, "view", "--serve", name, "--no-browser"],
            stdout=subprocess.PIPE, text=True, env=os.environ | {"PYTHONUNBUFFERED": "1"},
        )  # fmt: skip
        assert server.stdout is not None
        address = server.stdout.readline().strip()
        writer = multiprocessing.Process(target=write_run, args=(Path(name), seconds))
        writer.start()
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium") or "chromium", args=FLAGS
        )
        page = browser.new_page(viewport={"width": 1440, "height": 900})
        time.sleep(1)
        page.goto(f"{address}#v=gantt&f=1&p=live")
        page.wait_for_selector("html[data-ready]")
        page.wait_for_timeout(1500)
        page.evaluate(SAMPLE)
        while writer.is_alive() and page.evaluate("ncsimViewer.run.lines") < expected:
            page.wait_for_timeout(200)
        lags = page.evaluate("() => { clearInterval(timer); return lags; }")
        lines = page.evaluate("ncsimViewer.run.lines")
        browser.close()
        writer.join()
        server.terminate()
        server.wait()
    lags = [each for each in lags if each < 3600e3]
    middle, worst = statistics.median(lags), statistics.quantiles(lags, n=20)[-1]
    print(f"lag: median {middle:.0f} ms, 95 % below {worst:.0f} ms; {lines} of {expected} records")
    if lines != expected or middle > LAG_ms * SLACK:
        sys.exit(f"beyond the limit: {LAG_ms * SLACK:.0f} ms, {expected} records")


if __name__ == "__main__":
    main()
