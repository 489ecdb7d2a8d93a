"""Report size, first paint and frame time of the viewer for large made-up traces.

Usage: python benchmarks/viewer.py [events ...], by default 100000 and 1000000. Needs chromium and
playwright. Limits have slack for shared machines; medians of three loads and 120 frames.
"""

import json
import random
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

from ncsim_viz.document import report_html
from playwright.sync_api import sync_playwright

NODES = 200
LIMITS = {100_000: (1.6, 1500 * 2), 1_000_000: (14.0, 5000 * 2)}
"""By events: MB of the report, milliseconds until it shows (with slack 2)."""

FRAMES = """async () => { const el = document.querySelector('.glass canvas:last-of-type'); const out = []; let last = performance.now();
for (let i = 0; i < 120; i++) { el.dispatchEvent(new WheelEvent('wheel', {deltaY: i % 40 < 20 ? -1 : 1, ctrlKey: true, offsetX: 700, bubbles: true, cancelable: true}));
await new Promise(requestAnimationFrame); const now = performance.now(); out.push(now - last); last = now; } return out; }"""  # noqa: E501


def made_trace(path: Path, events: int) -> None:
    """Write a trace of about ``events`` atomic events, most of them changes of rate."""
    chooser = random.Random(1)
    pairs = events // 14
    header = {
        "format": "ncsim-trace", "version": "1.0", "time_unit": "us", "level": "full",
        "software": "made", "scenario": f"{events} events", "scenario_sha256": "", "seed": 1,
        "plugins": {}, "sections": {}, "kinds": {},
        "nodes": [[f"n{i}", 1.0, float(i % 20), float(i // 20)] for i in range(NODES)],
        "links": [
            [f"l{i}", i, (i + 1) % NODES, 2.0, 0.0, "wireless"] for i in range(NODES)
        ],
    }  # fmt: skip
    with path.open("w") as file:

        def put(**record: object) -> None:
            file.write(json.dumps(record, separators=(",", ":")) + "\n")

        put(**header)
        tasks = [[f"T{i}", 1.0] for i in range(2 * pairs)]
        edges = [[2 * i, 2 * i + 1, 1.0] for i in range(pairs)]
        nodes = [(i // 2 + i % 2) % NODES for i in range(2 * pairs)]
        put(t=0, k="inject", d=0, dag="made", i0=0, x0=0, tasks=tasks, edges=edges)
        put(t=0, k="place", d=0, n=nodes)
        active: list[int] = []
        t = 0
        for x in range(pairs):
            t += chooser.randrange(1, 2000)
            node = x % NODES
            put(t=t, k="ready", i=2 * x, n=node)
            put(t=t, k="start", i=2 * x, n=node)
            t += chooser.randrange(1, 2000)
            put(t=t, k="end", i=2 * x, n=node)
            put(t=t, k="xstart", x=x, route=[node], size=1.0)
            active.append(x)
            moved = active[-9:]
            rates = [chooser.random() for _ in moved]
            ones = [1] * len(moved)
            put(t=t, k="recalc", by=["s", x], x=moved, r=rates, l=[each % NODES for each in moved],
                nc=ones, nh=[0] * len(moved), fh=[1.0] * len(moved), f=ones)  # fmt: skip
            if len(active) > 40:
                put(t=t, k="xend", x=active.pop(0))
        put(t=t, k="done", status="completed", makespan_us=None, events=0, detail="", counts={})


def main() -> None:
    """Print one line per size, and fail above a limit."""
    sizes = [int(each) for each in sys.argv[1:]] or list(LIMITS)
    chromium = shutil.which("chromium") or "chromium"
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as name:
        browser = playwright.chromium.launch(
            executable_path=chromium, args=["--no-sandbox", "--disable-gpu"]
        )
        for events in sizes:
            trace = Path(name) / f"{events}.jsonl"
            made_trace(trace, events)
            report = trace.with_suffix(".html")
            report.write_text(report_html(trace), encoding="utf-8")
            paints = []
            for _ in range(3):
                page = browser.new_page(viewport={"width": 1440, "height": 900})
                page.goto(report.as_uri() + "#v=gantt&f=1")
                page.wait_for_selector("html[data-ready]", timeout=120_000)
                paints.append(int(page.locator("html").get_attribute("data-ready") or 0))
                frames = page.evaluate(FRAMES)
                page.close()
            size_MB, paint_ms = report.stat().st_size / 1e6, statistics.median(paints)
            print(
                f"{events:>8} events: {size_MB:.2f} MB, shown after {paint_ms:.0f} ms, "
                f"zoom frame median {statistics.median(frames):.0f} ms"
            )
            most_MB, most_ms = LIMITS.get(events, (size_MB, paint_ms))
            if size_MB > most_MB or paint_ms > most_ms:
                sys.exit(f"above the limit: {most_MB} MB, {most_ms} ms")
        browser.close()


if __name__ == "__main__":
    main()
