"""Usable without a mouse, with a screen reader, with little sight, and without motion."""

import pytest

VIEWS = [
    "overview", "gantt", "topology", "rates", "cascade", "replay", "dag", "compare", "events",
    "parameters",
]  # fmt: skip


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_nothing_serious_in_any_view(open_page, report, theme, serious_findings):
    page = open_page(report.as_uri() + "#s=x0&w=1000000-60000000", color_scheme=theme)
    found = {}
    for view in VIEWS:
        page.evaluate("view => ncsimViewer.page.store.set({view, asTable: false})", view)
        found[view] = serious_findings(page)
    page.evaluate("ncsimViewer.page.store.set({view: 'gantt', asTable: true, help: true})")
    found["a table, and the help"] = serious_findings(page)

    assert page.locator("html").get_attribute("data-theme") == theme
    assert {view: findings for view, findings in found.items() if findings} == {}


def test_every_canvas_has_words_and_is_reached_by_the_tab_key(page):
    page.keyboard.press("2")
    images = page.locator("canvas[role=img]")
    for i in range(images.count()):
        assert len(images.nth(i).get_attribute("aria-label") or "") > 20
    reached = set()
    for _ in range(40):
        page.keyboard.press("Tab")
        reached.add(
            page.evaluate("document.activeElement.className || document.activeElement.tagName")
        )

    assert "drawing" in reached


def test_what_has_the_focus_is_outlined(page):
    page.keyboard.press("Tab")

    assert page.evaluate("getComputedStyle(document.activeElement).outlineStyle") == "solid"


def test_j_and_k_select_without_a_mouse(page):
    page.keyboard.press("2")
    names = []
    for key in "jjk":
        page.keyboard.press(key)
        names.append(page.locator("aside h2").inner_text())

    assert names[0] == names[2] != names[1]


def test_the_event_at_the_playhead_is_said_while_it_stands(page):
    page.keyboard.press("ArrowLeft")
    said = page.locator("[aria-live=polite]").inner_text()
    page.keyboard.press("ArrowLeft")

    assert page.locator("[aria-live=polite]").inner_text() != said


@pytest.mark.parametrize("view", ["gantt", "rates", "topology"])
def test_at_200_percent_nothing_is_cut_off(open_page, report, view):
    # 1024 x 700 at 200 % is half as many CSS pixels.
    page = open_page(
        report.as_uri() + f"#v={view}",
        viewport={"width": 512, "height": 350},
        device_scale_factor=2,
    )

    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert page.locator(".drawing").bounding_box()["height"] >= 200
    page.locator("footer button").first.scroll_into_view_if_needed()
    assert page.locator("footer button").first.is_visible()
