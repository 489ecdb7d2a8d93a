"""The report in a real browser, from a file, without a network."""

import json
import random
import shutil

import pytest
from ncsim_core.api import prepare
from ncsim_core.generators.paper import paper_dag, paper_grid
from ncsim_core.scenario.loader import load_scenario
from ncsim_core.trace.loading import load_run
from ncsim_core.trace.writer import TraceWriter
from ncsim_viz.document import report_html

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
sync_api = pytest.importorskip(
    "playwright.sync_api", reason="no playwright: pip install playwright, to test the viewer"
)
pytestmark = pytest.mark.skipif(
    CHROMIUM is None, reason="no chromium: apt-get install chromium, to test the viewer"
)

VIEWS = [
    "overview",
    "gantt",
    "topology",
    "rates",
    "cascade",
    "dag",
    "compare",
    "events",
    "parameters",
]


def scenario_text():
    """Return the 4x4 grid with the 20-task DAG in Full."""
    network, dag = paper_grid(4), paper_dag(20)
    nodes = [
        {
            "id": node.id,
            "compute_capacity": node.compute_capacity,
            "position": {"x": node.position.x_m, "y": node.position.y_m},
        }
        for node in network.nodes
    ]
    links = [{"id": link.id, "from": link.source, "to": link.target} for link in network.links]
    tasks = [{"id": task.id, "compute_cost": task.compute_cost} for task in dag.tasks]
    edges = [
        {"from": each.source, "to": each.target, "data_size": 10.0} for each in dag.dependencies
    ]
    config = {"scheduler": "heft", "routing": "widest_path", "interference": "csma_bianchi"}
    document = {
        "name": "full",
        "network": {"nodes": nodes, "links": links},
        "dags": [{"id": dag.id, "tasks": tasks, "edges": edges}],
        "config": config,
    }
    return json.dumps({"scenario": document})


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    path = folder / "scenario.yaml"
    path.write_text(scenario_text())
    prepare(load_scenario(path), observers=[TraceWriter(folder / "trace.jsonl")]).run()
    (folder / "report.html").write_text(report_html(folder, folder), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def browser():
    with sync_api.sync_playwright() as playwright:
        launched = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"]
        )
        yield launched
        launched.close()


@pytest.fixture
def page(browser, run_folder):
    opened = browser.new_page(viewport={"width": 1024, "height": 700})
    opened.faults = []
    opened.requests = []
    opened.on("pageerror", lambda error: opened.faults.append(str(error)))
    opened.on("request", lambda request: opened.requests.append(request.url))
    opened.goto((run_folder / "report.html").as_uri())
    opened.wait_for_selector("html[data-ready]", timeout=20_000)
    yield opened
    assert opened.faults == []
    opened.close()


def state_from_the_start(lines, event):  # noqa: C901 - one case for each kind
    """Return what goes on after an event: the plainest replay of the trace."""
    records = [json.loads(line) for line in lines[1 : event + 2]]
    running, queued, rates, place = {}, {}, {}, {}
    for record in records:
        match record["k"]:
            case "place":
                place = dict(enumerate(record["n"]))
            case "ready":
                queued[place[record["i"]]] = queued.get(place[record["i"]], 0) + 1
            case "start":
                queued[record["n"]] -= 1
                running[record["n"]] = record["i"]
            case "end":
                del running[record["n"]]
            case "xstart":
                rates[record["x"]] = 0.0
            case "xend":
                del rates[record["x"]]
            case "recalc":
                rates.update(zip(record["x"], record["r"], strict=True))
    return {
        "event": event,
        "running": [running.get(node, -1) for node in range(16)],
        "queued": [queued.get(node, 0) for node in range(16)],
        "active": [list(each) for each in sorted(rates.items())],
    }


def test_the_report_asks_the_network_for_nothing(page):
    assert [url for url in page.requests if not url.startswith(("file:", "blob:", "data:"))] == []


def test_the_state_at_200_random_records_equals_a_replay_from_the_start(page, run_folder):
    lines = (run_folder / "trace.jsonl").read_text().splitlines()
    chooser = random.Random(1)
    events = [chooser.randrange(len(lines) - 1) for _ in range(200)]

    shown = page.evaluate(
        "events => events.map(e => (ncsimViewer.seek(e), ncsimViewer.state()))", events
    )

    assert shown == [state_from_the_start(lines, event) for event in events]


def test_the_integral_of_rate_is_the_size_of_every_transfer(page, run_folder):
    served = page.evaluate(
        "() => { const r = ncsimViewer.run; return Array.from({length: r.transfers}, "
        "(_, x) => r.isLocal(x) ? null : r.servedBy(x, r.end)); }"
    )

    for transfer, served_MB in zip(load_run(run_folder).transfers, served, strict=True):
        if not transfer.is_local:
            assert served_MB == pytest.approx(transfer.size_MB, abs=4e-6)


@pytest.mark.parametrize("view", VIEWS)
def test_every_view_opens_by_key_and_in_both_themes(page, view):
    page.keyboard.press(str(VIEWS.index(view) + 1))
    page.keyboard.press("d")

    assert page.locator("nav button[aria-current=page]").inner_text().lower().endswith(view)
    assert f"v={view}" in page.url


@pytest.mark.parametrize("view", VIEWS[:6])
def test_every_drawing_has_a_table_twin_and_exports_svg(page, view):
    page.keyboard.press(str(VIEWS.index(view) + 1))
    page.keyboard.press("t")

    assert page.locator("table tbody tr").count() > 2
    assert page.evaluate("view => ncsimViewer.svg(view)", view).startswith("<svg xmlns")


def test_the_brackets_step_from_recalculation_to_recalculation_at_one_instant(page):
    page.keyboard.press("5")
    page.evaluate("ncsimViewer.goTo(-1)")
    lines = []
    for _ in range(5):
        page.keyboard.press("]")
        lines.append(page.evaluate("ncsimViewer.state().event"))

    assert len(set(lines)) == 5
    assert lines == sorted(lines)


def test_a_deep_link_survives_reload(page):
    page.keyboard.press("2")
    page.keyboard.press("+")
    page.keyboard.press("c")
    before = page.url
    page.reload()
    page.wait_for_selector("html[data-ready]")

    assert page.url == before


def test_a_hostile_node_name_runs_nothing(browser, run_folder, tmp_path):
    hostile = "</script><img src=x onerror=window.hacked=1>"
    text = (
        (run_folder / "trace.jsonl").read_text().replace('["n4",', json.dumps([hostile])[:-1] + ",")
    )
    (tmp_path / "trace.jsonl").write_text(text)
    path = tmp_path / "report.html"
    path.write_text(report_html(tmp_path), encoding="utf-8")
    opened = browser.new_page()
    opened.goto(path.as_uri())
    opened.wait_for_selector("html[data-ready]")
    for key in "123456789":
        opened.keyboard.press(key)

    assert opened.evaluate("window.hacked") is None
    assert opened.locator("img").count() == 0
    assert "<img" not in opened.evaluate("ncsimViewer.svg('topology')")
    opened.close()
