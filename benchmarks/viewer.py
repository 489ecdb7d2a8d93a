"""Size, first paint, frames, replay and layout of the viewer for large made-up runs.

Usage: python benchmarks/viewer.py [events ...], by default 100000 and 1000000. Needs chromium and
playwright. Prints one line per figure with its limit and fails above a limit. Limits of time are
twice those of the specification, for shared machines; figures are medians of three loads and of
120 frames of zooming and of panning, in milliseconds of wall time.
"""

import json
import random
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

from ncsim_viz.document import report_html
from playwright.sync_api import Browser, Page, sync_playwright

FLAGS = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]  # fmt: skip
SLACK = 2.0
LIMITS = {100_000: (1.6, 1500.0), 1_000_000: (14.0, 5000.0)}
"""By events: MB of the report, milliseconds until it shows."""
FRAME_ms = 33.0
REPLAY_fps = 30.0
LAYOUT_ms = 200.0
COLUMNS = 20
RATES_MBps = [
    goodput / flows * factor
    for goodput in (0.79, 1.55, 2.27, 2.97, 4.27, 5.49, 6.07, 6.63, 7.71, 8.21, 9.15, 9.82)
    for flows in range(1, 9)
    for factor in (1.0, 0.97, 0.81, 0.52, 1 / 3)
]
"""Full-precision rates, as many different ones as 12 schemes, shares and hidden factors give."""

WHEEL = """() => { const e = document.querySelector('.glass canvas + canvas'); window.act = i =>
e.dispatchEvent(new WheelEvent('wheel', {deltaY: i % 40 < 20 ? -1 : 1, ctrlKey: true,
clientX: 700, clientY: 300, bubbles: true, cancelable: true})); }"""
PAN = """() => { ncsimViewer.page.zoom(0.1); window.act = i => { const p = ncsimViewer.page;
const [from, to] = p.store.ui.window, step = (to - from) / 50;
p.pan(from, to, i % 40 < 20 ? step : -step); }; }"""
FRAMES = """async () => { const out = []; let last = performance.now();
for (let i = 0; i < 120; i++) { act(i); await new Promise(requestAnimationFrame);
const now = performance.now(); out.push(now - last); last = now; } return out; }"""
REPLAY = """async () => { const p = ncsimViewer.page; p.goTo(-1);
p.store.set({replaySeconds: 20, playing: true});
let frames = 0; const start = performance.now();
while (performance.now() - start < 3000) { await new Promise(requestAnimationFrame); frames++; }
p.store.set({playing: false}); return frames / (performance.now() - start) * 1000; }"""
LAYOUT = """() => { const p = ncsimViewer.page, out = []; for (let i = 0; i < 5; i++) { p.changed();
const start = performance.now(); ncsimViewer.view('dag').height(p.context(), 1400, 800);
out.push(performance.now() - start); } return out; }"""


def made_trace(path: Path, events: int, nodes: int = 200) -> None:
    """Write a trace of about ``events`` atomic events, most of them changes of rate."""
    chooser = random.Random(1)
    pairs = events // 14
    links = neighbours(nodes)
    with path.open("w") as file:

        def put(**record: object) -> None:
            file.write(json.dumps(record, separators=(",", ":")) + "\n")

        put(**header(f"{events} events", nodes, links))
        tasks = [[f"T{i}", 1.0] for i in range(2 * pairs)]
        edges = [[2 * i, 2 * i + 1, 1.0] for i in range(pairs)]
        places = [(i // 2 + i % 2) % nodes for i in range(2 * pairs)]
        put(t=0, k="inject", d=0, dag="made", i0=0, x0=0, tasks=tasks, edges=edges)
        put(t=0, k="place", d=0, n=places)
        active: list[int] = []
        t = 0
        for x in range(pairs):
            t += chooser.randrange(1, 2000)
            node = x % nodes
            put(t=t, k="ready", i=2 * x, n=node)
            put(t=t, k="start", i=2 * x, n=node)
            t += chooser.randrange(1, 2000)
            put(t=t, k="end", i=2 * x, n=node)
            put(t=t, k="xstart", x=x, route=[node], size=1.0)
            active.append(x)
            moved = active[-9:]
            rates = [chooser.choice(RATES_MBps) for _ in moved]
            ones = [1] * len(moved)
            put(t=t, k="recalc", by=["s", x], x=moved, r=rates, l=[each % nodes for each in moved],
                nc=ones, nh=[0] * len(moved), fh=[1.0] * len(moved), f=ones)  # fmt: skip
            if len(active) > 40:
                put(t=t, k="xend", x=active.pop(0))
        put(t=t, k="done", status="completed", makespan_us=None, events=0, detail="", counts={})


def neighbours(nodes: int) -> list[tuple[int, int]]:
    """Return links of a grid in eight directions; link i begins at node i for i below ``nodes``."""
    steps = [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)]
    found = [(i, (i + 1) % nodes) for i in range(nodes)]
    for i in range(nodes):
        for dx, dy in steps[1:]:
            other = i + dx + dy * COLUMNS
            if 0 <= i % COLUMNS + dx < COLUMNS and 0 <= other < nodes:
                found.append((i, other))
    return found


def header(name: str, nodes: int, links: list[tuple[int, int]]) -> dict[str, object]:
    """Return the first record of a trace."""
    return {
        "format": "ncsim-trace", "version": "1.0", "time_unit": "us", "level": "full",
        "software": "made", "scenario": name, "scenario_sha256": "", "seed": 1, "plugins": {},
        "sections": {}, "kinds": {},
        "nodes": [[f"n{i}", 1.0, float(i % COLUMNS), float(i // COLUMNS)] for i in range(nodes)],
        "links": [[f"l{i}", a, b, 2.0, 0.0, "wireless"] for i, (a, b) in enumerate(links)],
    }  # fmt: skip


def made_dag(path: Path, tasks: int) -> None:
    """Write a trace in which one random DAG has entered."""
    chooser = random.Random(2)
    edges = [[chooser.randrange(i), i, 1.0] for i in range(1, tasks) for _ in range(2)]
    inject = {"t": 0, "k": "inject", "d": 0, "dag": "wide", "i0": 0, "x0": 0, "edges": edges}
    inject["tasks"] = [[f"T{i}", 1.0] for i in range(tasks)]
    records = [header("DAG", 4, neighbours(4)), inject]
    path.write_text("".join(json.dumps(record) + "\n" for record in records))


class Limits:
    """Prints figures and remembers those beyond their limit."""

    def __init__(self) -> None:
        self.broken: list[str] = []

    def at_most(self, name: str, figure: float, limit: float, unit: str) -> None:
        """Print a figure that should not be greater."""
        self._line(f"{name}: {figure:.2f} {unit} (at most {limit:g})", is_good=figure <= limit)

    def at_least(self, name: str, figure: float, limit: float, unit: str) -> None:
        """Print a figure that should not be less."""
        self._line(f"{name}: {figure:.1f} {unit} (at least {limit:g})", is_good=figure >= limit)

    def _line(self, text: str, *, is_good: bool) -> None:
        print(text if is_good else f"{text}  BEYOND THE LIMIT", flush=True)
        if not is_good:
            self.broken.append(text)


def opened(browser: Browser, report: Path, state: str) -> Page:
    """Open a report at a state and wait until it shows."""
    page = browser.new_page(viewport={"width": 1440, "height": 900})
    page.goto(f"{report.as_uri()}#{state}")
    page.wait_for_selector("html[data-ready]", timeout=120_000)
    return page


def report_of(trace: Path) -> Path:
    """Write the report of a trace beside it."""
    report = trace.with_suffix(".html")
    report.write_text(report_html(trace), encoding="utf-8")
    return report


def measure_gantt(browser: Browser, folder: Path, events: int, limits: Limits) -> None:
    """Size, first paint, and frames of the Gantt chart."""
    made_trace(folder / f"{events}.jsonl", events)
    report = report_of(folder / f"{events}.jsonl")
    paints: list[float] = []
    frames: dict[str, list[float]] = {"zoom": [], "pan": []}
    for _ in range(3):
        page = opened(browser, report, "v=gantt&f=1")
        paints.append(float(page.locator("html").get_attribute("data-ready") or 0))
        for name, prepare in (("zoom", WHEEL), ("pan", PAN)):
            page.evaluate(prepare)
            frames[name] += page.evaluate(FRAMES)
        page.close()
    size_MB, shown_ms = LIMITS.get(events, (float("inf"), float("inf")))
    limits.at_most(f"{events} events, report", report.stat().st_size / 1e6, size_MB, "MB")
    limits.at_most(
        f"{events} events, shown after", statistics.median(paints), shown_ms * SLACK, "ms"
    )
    for name, found in frames.items():
        limits.at_most(
            f"{events} events, {name} frame", statistics.median(found), FRAME_ms * SLACK, "ms"
        )


def measure_replay(browser: Browser, folder: Path, limits: Limits) -> None:
    """Frames per second of a replay with 500 nodes."""
    made_trace(folder / "replay.jsonl", 100_000, nodes=500)
    report = report_of(folder / "replay.jsonl")
    for view in ("topology", "replay"):
        page = opened(browser, report, f"v={view}")
        links = page.evaluate("ncsimViewer.run.links.length")
        fps = page.evaluate(REPLAY)
        limits.at_least(f"{view}, 500 nodes, {links} links", fps, REPLAY_fps / SLACK, "frames/s")
        page.close()


def measure_layout(browser: Browser, folder: Path, limits: Limits) -> None:
    """Layout of a DAG of 1,000 tasks."""
    made_dag(folder / "dag.jsonl", 1000)
    page = opened(browser, report_of(folder / "dag.jsonl"), "v=dag")
    found = statistics.median(page.evaluate(LAYOUT))
    limits.at_most("layout of a DAG of 1000 tasks", found, LAYOUT_ms, "ms")
    page.close()


def main() -> None:
    """Print a line per figure, and fail beyond a limit."""
    sizes = [int(each) for each in sys.argv[1:]] or list(LIMITS)
    limits = Limits()
    chromium = shutil.which("chromium") or "chromium"
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as name:
        browser = playwright.chromium.launch(executable_path=chromium, args=FLAGS)
        for events in sizes:
            measure_gantt(browser, Path(name), events, limits)
        measure_replay(browser, Path(name), limits)
        measure_layout(browser, Path(name), limits)
        browser.close()
    if limits.broken:
        sys.exit("beyond the limit: " + "; ".join(limits.broken))


if __name__ == "__main__":
    main()
