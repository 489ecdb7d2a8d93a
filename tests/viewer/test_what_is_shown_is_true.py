"""State, hits and sums on the page against plain replays of the trace in Python."""

import json
import random

import pytest
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.loading import load_run
from ncsim_core.trace.records import TraceHeader
from ncsim_core.trace.writer import TraceWriter
from ncsim_viz.document import report_html


def state_from_the_start(records, event):  # noqa: C901 - one case for each kind
    """Return what goes on after an event: the plainest replay of the trace."""
    running, queued, rates, place = {}, {}, {}, {}
    for record in records[1 : event + 2]:
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
    nodes = len(records[0]["nodes"])
    return {
        "event": event,
        "running": [running.get(node, -1) for node in range(nodes)],
        "queued": [queued.get(node, 0) for node in range(nodes)],
        "active": [list(each) for each in sorted(rates.items())],
    }


def records_of(folder):
    return [json.loads(line) for line in (folder / "trace.jsonl").read_text().splitlines()]


def test_the_state_at_200_random_sequence_numbers_equals_a_replay_from_the_start(page, grid_runs):
    records = records_of(grid_runs[0])
    chooser = random.Random(1)
    events = [chooser.randrange(len(records) - 1) for _ in range(200)]

    shown = page.evaluate(
        "events => events.map(e => (ncsimViewer.seek(e), ncsimViewer.state()))", events
    )

    assert shown == [state_from_the_start(records, event) for event in events]


def test_the_state_at_200_random_instants_is_that_after_the_last_event_until_then(page, grid_runs):
    records = records_of(grid_runs[0])
    times = [record["t"] for record in records[1:]]
    chooser = random.Random(2)
    asked = [chooser.randrange(times[-1] + 1) for _ in range(150)] + chooser.sample(times, 50)

    shown = page.evaluate(
        "ts => ts.map(t => (ncsimViewer.page.goToTime(t), "
        "ncsimViewer.seek(ncsimViewer.page.store.ui.event), ncsimViewer.state()))",
        asked,
    )

    last = [sum(time <= at for time in times) - 1 for at in asked]
    assert shown == [state_from_the_start(records, event) for event in last]


def test_the_integral_of_rate_is_the_size_of_every_transfer(page, grid_runs):
    served = page.evaluate(
        "() => { const r = ncsimViewer.run; return Array.from({length: r.transfers}, "
        "(_, x) => r.isLocal(x) ? null : r.servedBy(x, r.end)); }"
    )

    remote = 0
    for transfer, served_MB in zip(load_run(grid_runs[0]).transfers, served, strict=True):
        if not transfer.is_local:
            remote += 1
            assert served_MB == pytest.approx(transfer.size_MB, abs=4e-6)
    assert remote == 13


COLUMN = """([x, rows]) => { const v = ncsimViewer.view('gantt'), ctx = ncsimViewer.page.context();
const box = {width: 1000, height: 600, top: 0, bottom: 600};
const hits = rows.map(y => v.hit(ctx, box, x, y)).filter(Boolean).map(h => h.kind + ' ' + h.id);
return [...new Set(hits)].sort(); }"""


def test_hits_in_the_gantt_chart_are_what_brute_force_finds(page, grid_runs):
    left, right = 110, 1000 - 12  # where the time axis begins and ends
    run = load_run(grid_runs[0])
    spans = {f"task {i}": (each.started_us, each.ended_us) for i, each in enumerate(run.tasks)} | {
        f"transfer {i}": (each.started_us, each.ended_us)
        for i, each in enumerate(run.transfers)
        if not each.is_local
    }
    end_us = max(ended for _, ended in spans.values())
    slack_us = 3 * end_us / (right - left)  # a bar is hit from two pixels beside it
    ends = [at for span in spans.values() for at in span]
    chooser = random.Random(3)
    instants = [chooser.randrange(end_us) for _ in range(150)]
    instants = [at for at in instants if all(abs(at - end) > slack_us for end in ends)]

    assert len(instants) > 60
    for at in instants:
        x = left + at / end_us * (right - left)
        hits = page.evaluate(COLUMN, [x, list(range(25, 600, 3))])
        assert hits == sorted(name for name, (begun, ended) in spans.items() if begun < at < ended)


@pytest.fixture
def worked_page(open_page, tmp_path):
    """The report of the paper's Appendix B."""
    worked_example(TraceWriter(tmp_path / "trace.jsonl", TraceHeader("B", "cafe", 7))).run()
    path = tmp_path / "report.html"
    path.write_text(report_html(tmp_path), encoding="utf-8")
    return open_page(path.as_uri())


def table_of(page, view):
    return page.evaluate(
        "view => ncsimViewer.view(view).table(ncsimViewer.page.context()).rows", view
    )


def test_the_papers_worked_example_shows_its_staircase(worked_page):
    rows = table_of(worked_page, "rates")
    stairs = {}
    for transfer, from_s, rate_MBps, *_, cause in rows:
        stairs.setdefault(transfer, []).append((float(from_s), rate_MBps, cause[0]))

    # Appendix B: A's data has 2 MB/s alone, 1 MB/s while B's shares the second hop, then 2 again.
    assert list(stairs.values()) == [
        [(1.0, 2.0, "▲"), (2.0, 1.0, "▲"), (3.0, 2.0, "●")],
        [(2.0, 1.0, "▲")],
    ]


def test_the_papers_worked_example_shows_its_cascade(worked_page):
    worked_page.keyboard.press("5")
    worked_page.evaluate("ncsimViewer.goTo(-1)")
    seen = []
    for _ in range(3):
        worked_page.keyboard.press("]")
        seen.append([(row[1], row[2], float(row[7])) for row in table_of(worked_page, "cascade")])

    # Before and after in MB/s, and when it would end at that rate: 4 MB from 1 s, 1 MB from 2 s.
    assert [sorted(each) for each in seen] == [
        [(0, 2, 3.0)],
        [(0, 1, 3.0), (2, 1, 4.0)],
        [(1, 2, 3.5)],
    ]
    assert worked_page.evaluate("ncsimViewer.run.done.makespan") == 5_000_000


def test_a_dag_of_a_thousand_tasks_is_drawn_with_every_edge_forward(made_report, open_page):
    chooser = random.Random(4)
    edges = [[chooser.randrange(i), i, 1.0] for i in range(1, 1000) for _ in range(2)]
    header = {
        "format": "ncsim-trace", "version": "1.0", "time_unit": "us", "level": "full",
        "software": "x", "scenario": "wide", "scenario_sha256": "", "seed": 1, "plugins": {},
        "sections": {}, "nodes": [["n", 1.0, None, None]], "links": [], "kinds": {},
    }  # fmt: skip
    tasks = [[f"T{i}", 1.0] for i in range(1000)]
    inject = {"t": 0, "k": "inject", "d": 0, "dag": "d", "i0": 0, "x0": 0}
    place = {"t": 0, "k": "place", "d": 0, "n": [0] * 1000}
    page = open_page(
        made_report([header, inject | {"tasks": tasks, "edges": edges}, place]).as_uri() + "#v=dag"
    )

    layers = page.evaluate(
        "() => { const v = ncsimViewer.svg('dag'); return [...v.matchAll(/<polyline points="
        '"([-0-9.]+) [-0-9.]+ ([-0-9.]+)/g)].map(m => m[2] - m[1]); }'
    )
    assert len(layers) >= 1998
    assert min(layers) > 0
