"""A browser, and the run that most tests look at."""

import json
import shutil
import time
from pathlib import Path

import pytest
from ncsim_core.api import prepare
from ncsim_core.scenario.loader import load_scenario
from ncsim_core.trace.writer import TraceWriter
from ncsim_viz.document import report_html

ROOT = Path(__file__).parents[2]
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
FLAGS = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]  # fmt: skip
"""--disable-gpu: with SwiftShader a canvas is ten times slower."""

AXE = ROOT / "ncsim-viz" / "frontend" / "node_modules" / "axe-core" / "axe.min.js"
CHECK = """async () => {
  const {violations} = await axe.run(document, {resultTypes: ['violations']});
  return violations.filter(v => v.impact === 'serious' || v.impact === 'critical')
    .map(v => v.id + ': ' + v.nodes.map(n => n.target.join(' ')).slice(0, 3).join(', '));
}"""


@pytest.fixture(scope="session")
def browser():
    sync_api = pytest.importorskip(
        "playwright.sync_api", reason="no playwright: pip install playwright, to test the viewer"
    )
    if CHROMIUM is None:
        pytest.skip("no chromium: apt-get install chromium, to test the viewer")
    with sync_api.sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield launched
        launched.close()


@pytest.fixture(scope="session")
def grid_runs(tmp_path_factory):
    """The 4x4 grid with 20 tasks, once in Full and once in Solo: two folders."""
    folders = []
    for name, interference in (("full", "csma_bianchi"), ("solo", "none")):
        folder = tmp_path_factory.mktemp(name)
        text = (ROOT / "examples" / "grid_4x4.yaml").read_text()
        path = folder / "scenario.yaml"
        path.write_text(text)
        prepare(
            load_scenario(path),
            interference=interference,
            observers=[TraceWriter(folder / "trace.jsonl")],
        ).run()
        folders.append(folder)
    return folders


@pytest.fixture(scope="session")
def report(grid_runs):
    full, solo = grid_runs
    path = full / "report.html"
    path.write_text(report_html(full, solo), encoding="utf-8")
    return path


@pytest.fixture
def open_page(browser):
    """Open a page and fail the test if anything goes wrong on it."""
    opened, faults = [], []

    def opening(address, **how):
        page = browser.new_page(**({"viewport": {"width": 1024, "height": 700}} | how))
        opened.append(page)
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.goto(address)
        page.wait_for_selector("html[data-ready]", timeout=20_000)
        return page

    yield opening
    for page in opened:
        page.close()
    assert faults == []


@pytest.fixture
def until():
    """Wait until an expression holds; unlike Playwright's wait also under the page's own policy."""

    def waiting(page, expression, timeout_s=20.0):
        end_s = time.monotonic() + timeout_s
        while not page.evaluate(expression):
            assert time.monotonic() < end_s, f"not in {timeout_s} s: {expression}"
            page.wait_for_timeout(30)

    return waiting


@pytest.fixture
def page(open_page, report):
    return open_page(report.as_uri())


@pytest.fixture
def made_report(tmp_path):
    """Make a report of a trace given as records, the header first."""

    def making(records):
        folder = tmp_path / "made"
        folder.mkdir()
        lines = [json.dumps(record) for record in records]
        (folder / "trace.jsonl").write_text("\n".join(lines) + "\n", encoding="utf-8")
        path = folder / "report.html"
        path.write_text(report_html(folder), encoding="utf-8")
        return path

    return making


@pytest.fixture(scope="session")
def serious_findings():
    """Ask axe-core for what it finds serious or worse on a page."""
    if not AXE.is_file():
        pytest.skip("no axe-core: npm ci in ncsim-viz/frontend, to audit the viewer")
    axe = AXE.read_text(encoding="utf-8")

    def finding(page):
        if not page.evaluate("'axe' in window"):
            page.evaluate(axe)  # by the debugger: the page's own policy forbids other scripts
        return page.evaluate(CHECK)

    return finding
