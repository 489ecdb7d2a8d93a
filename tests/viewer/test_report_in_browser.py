"""The report in a real browser, from a file, without a network."""

import json

import pytest

VIEWS = {
    "1": "overview", "2": "gantt", "3": "topology", "4": "rates", "5": "cascade", "6": "replay",
    "7": "dag", "8": "compare", "9": "events", "p": "parameters",
}  # fmt: skip
DRAWN = [view for view in VIEWS.values() if view not in ("events", "parameters")]


def wait_for_address(page, text):
    page.wait_for_function("text => location.hash.includes(text)", arg=text)


def test_the_report_asks_the_network_for_nothing(browser, report):
    page = browser.new_page()
    requests = []
    page.on("request", lambda request: requests.append(request.url))
    page.goto(report.as_uri())
    page.wait_for_selector("html[data-ready]")
    page.close()

    assert [url for url in requests if not url.startswith(("file:", "blob:", "data:"))] == []


def test_every_view_opens_by_its_key_and_is_drawn_in_both_themes(page):
    for key, view in VIEWS.items():
        page.keyboard.press(key)
        page.keyboard.press("d")

        wait_for_address(page, f"v={view}")
        assert page.locator("nav button[aria-current=page]").inner_text().startswith(key)


def test_every_drawing_has_a_table_twin_and_exports_svg_and_png(page):
    page.evaluate("ncsimViewer.goTo(44)")  # several transfers are in service
    for view in DRAWN:
        page.evaluate("view => ncsimViewer.page.store.set({view, asTable: true})", view)

        assert page.locator("table tbody tr").count() > 2, view
        assert page.evaluate("view => ncsimViewer.svg(view)", view).startswith("<svg xmlns"), view
        width, inked = page.evaluate(
            "view => { const c = ncsimViewer.sheet(view); const d = c.getContext('2d')"
            ".getImageData(0, 0, c.width, Math.min(c.height, 900)).data; let n = 0; "
            "for (let i = 0; i < d.length; i += 4) n += d[i] + d[i + 1] + d[i + 2] < 600; "
            "return [c.width, n]; }",
            view,
        )
        assert width == 2400, view
        assert inked > 500, view


def test_the_brackets_step_from_recalculation_to_recalculation_at_one_instant(page):
    page.keyboard.press("5")
    page.evaluate("ncsimViewer.goTo(-1)")
    events = []
    for _ in range(5):
        page.keyboard.press("]")
        events.append(page.evaluate("ncsimViewer.state().event"))

    assert len(set(events)) == 5
    assert events == sorted(events)


def test_a_deep_link_survives_reload(page):
    page.keyboard.press("2")
    page.keyboard.press("+")
    page.keyboard.press("c")
    wait_for_address(page, "c=1")
    before = page.url
    page.reload()
    page.wait_for_selector("html[data-ready]")

    assert page.url == before


def test_a_window_brushed_in_the_strip_is_that_of_every_view(page):
    box = page.locator(".strip").bounding_box()
    for share, act in ((0.25, "down"), (0.5, "move"), (0.5, "up")):
        page.mouse.move(box["x"] + share * box["width"], box["y"] + 20)
        if act != "move":
            getattr(page.mouse, act)()
    shown = page.evaluate("ncsimViewer.page.store.ui.window")

    whole_us = page.evaluate("ncsimViewer.run.end")
    assert shown == pytest.approx([0.25 * whole_us, 0.5 * whole_us], rel=0.02)
    page.keyboard.press("4")
    rows = page.evaluate("ncsimViewer.view('rates').table(ncsimViewer.page.context()).rows")
    assert {row[0] for row in rows} != set()
    page.keyboard.press("0")
    assert page.evaluate("ncsimViewer.page.store.ui.window") is None


def test_a_selection_made_in_one_view_is_marked_in_the_others(page):
    page.keyboard.press("2")
    page.evaluate("ncsimViewer.page.select({kind: 'transfer', id: 0})")
    selected = "#d1006c"
    for view in ("gantt", "topology", "rates", "dag", "compare"):
        assert selected in page.evaluate("view => ncsimViewer.svg(view)", view), view
    page.keyboard.press("Escape")
    page.evaluate("ncsimViewer.goTo(-1)")
    for view in ("gantt", "topology", "rates", "dag", "compare"):
        assert selected not in page.evaluate("view => ncsimViewer.svg(view)", view), view


def test_causes_are_followed_backwards_by_keyboard(page):
    page.evaluate("ncsimViewer.page.select({kind: 'task', id: 19})")
    names = []
    for _ in range(3):
        names.append(page.locator("aside h2").inner_text())
        page.locator("aside .causes button").first.press("Enter")

    assert names[0] == "task T19"
    assert len(set(names)) == 3


def test_a_replay_reaches_the_end_and_loops_over_a_window(open_page, report):
    page = open_page(report.as_uri() + "#v=replay&n=1&e=0")
    page.keyboard.press("Space")
    page.wait_for_function("!ncsimViewer.page.store.ui.playing", timeout=10_000)

    assert page.evaluate("ncsimViewer.state().event === ncsimViewer.run.events - 1")

    page.evaluate("ncsimViewer.page.setWindow(1e6, 3e6)")
    page.keyboard.press("l")
    page.keyboard.press("Space")
    page.wait_for_timeout(300)
    assert page.evaluate("ncsimViewer.page.store.ui.playing")
    assert 1e6 <= page.evaluate("ncsimViewer.page.store.ui.time") <= 3e6


def test_where_motion_is_not_wanted_playing_steps_once(open_page, report):
    page = open_page(report.as_uri() + "#v=replay&e=3", reduced_motion="reduce")
    page.keyboard.press("Space")

    assert page.evaluate("[ncsimViewer.state().event, ncsimViewer.page.store.ui.playing]") == [
        4,
        False,
    ]


def test_compare_shows_both_runs_with_what_each_transfer_lost(page):
    rows = page.evaluate("ncsimViewer.view('compare').table(ncsimViewer.page.context()).rows")
    makespan = next(row for row in rows if row[0] == "makespan s")
    transfers = [row for row in rows if row[0] == "transfer"]

    assert makespan[2] > makespan[3]  # Full takes longer than Solo
    assert len(transfers) == 13
    assert all(row[4] < 0 for row in transfers)  # in Solo every transfer ends earlier


def test_csv_holds_what_the_table_shows(page):
    page.keyboard.press("3")
    with page.expect_download() as download:
        page.get_by_role("button", name="CSV").click()
    lines = download.value.path().read_text().splitlines()

    assert lines[0].startswith("link,from,to,")
    assert len(lines) == 1 + page.evaluate("ncsimViewer.run.links.length")


def test_the_report_works_in_a_sandboxed_frame_as_notebooks_show_it(browser, report):
    page = browser.new_page()
    page.set_content("<iframe sandbox='allow-scripts' style='width:900px;height:600px'></iframe>")
    page.evaluate("html => { document.querySelector('iframe').srcdoc = html; }", report.read_text())
    frame = page.frame_locator("iframe")
    frame.locator("nav button").nth(1).click(timeout=20_000)
    page.wait_for_timeout(300)

    assert frame.locator("nav button[aria-current=page]").inner_text() == "2 Gantt"
    page.close()


def test_an_unfinished_trace_opens_and_says_so(made_report, open_page, grid_runs):
    lines = (grid_runs[0] / "trace.jsonl").read_text().splitlines()[:60]
    page = open_page(made_report([json.loads(line) for line in lines]).as_uri())

    assert page.locator("header .status").inner_text() == "truncated"


def test_an_event_that_is_clicked_takes_the_playhead_and_what_it_is_about(page):
    page.keyboard.press("9")
    page.locator(".rows tbody button").nth(10).click()

    line = int(page.locator(".rows tbody tr[aria-current] td").first.inner_text())
    assert page.evaluate("ncsimViewer.run.evLine.data[ncsimViewer.state().event]") == line


def test_a_table_says_what_it_leaves_out_and_its_csv_leaves_out_nothing(made_report, open_page):
    header = {
        "format": "ncsim-trace", "version": "1.0", "time_unit": "us", "level": "full",
        "software": "x", "scenario": "long", "scenario_sha256": "", "seed": 1, "plugins": {},
        "sections": {}, "nodes": [["n", 1.0, None, None]], "links": [], "kinds": {},
    }  # fmt: skip
    inject = {"t": 0, "k": "inject", "d": 0, "dag": "d", "i0": 0, "x0": 0, "edges": []}
    inject["tasks"] = [[f"T{i}", 1.0] for i in range(2500)]
    place = {"t": 0, "k": "place", "d": 0, "n": [0] * 2500}
    rest = [
        {"t": i, "k": kind, "i": i, "n": 0}
        for i in range(2500)
        for kind in ("ready", "start", "end")
    ]
    page = open_page(made_report([header, inject, place, *rest]).as_uri() + "#v=events")
    with page.expect_download() as download:
        page.get_by_role("button", name="CSV").click()

    assert "The first 5000 of 7502 rows" in page.locator(".rows .note").inner_text()
    assert len(download.value.path().read_text().splitlines()) == 1 + 7502


def test_the_map_is_enlarged_by_wheel_and_keys_and_keeps_that_in_its_address(page):
    page.keyboard.press("3")
    box = page.locator(".drawing").bounding_box()
    page.mouse.move(box["x"] + 200, box["y"] + 150)
    page.mouse.wheel(0, -100)
    wait_for_address(page, "z=1.25")
    page.keyboard.press("+")
    wait_for_address(page, "z=2.5")
    page.reload()
    page.wait_for_selector("html[data-ready]")

    assert page.evaluate("ncsimViewer.page.store.ui.map.scale") == 2.5
    page.keyboard.press("0")
    assert page.evaluate("ncsimViewer.page.store.ui.map") is None
