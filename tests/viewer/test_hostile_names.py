"""Names that try to run something: they stay text on the page and in every export."""

import json
import re
from xml.etree import ElementTree

HOSTILE = "</script><img src=x onerror=window.hacked=1>"
SHAPES = {
    "svg", "title", "rect", "polyline", "polygon", "circle", "text", "clipPath", "g", "image",
}  # fmt: skip
VIEWS = ["overview", "gantt", "topology", "rates", "cascade", "replay", "dag", "compare"]


def hostile_records(folder):
    """Return the run's trace with every name of node, link, DAG and task hostile."""
    records = [json.loads(line) for line in (folder / "trace.jsonl").read_text().splitlines()]
    header = records[0]
    header["scenario"] = HOSTILE
    header["nodes"] = [[HOSTILE + node[0], *node[1:]] for node in header["nodes"]]
    header["links"] = [[HOSTILE + link[0], *link[1:]] for link in header["links"]]
    for record in records:
        if record.get("k") == "inject":
            record["dag"] = HOSTILE
            record["tasks"] = [[HOSTILE + task[0], *task[1:]] for task in record["tasks"]]
    return records


def test_a_hostile_name_runs_nothing_on_the_page_and_in_no_export(
    made_report, open_page, grid_runs
):
    page = open_page(made_report(hostile_records(grid_runs[0])).as_uri())
    for kind in ("task", "transfer", "link", "node", "recalc"):
        page.evaluate("kind => ncsimViewer.page.select({kind, id: 1})", kind)
        for key in ["1", "2", "3", "4", "5", "6", "7", "8", "9", "p", "t", "t"]:
            page.keyboard.press(key)
    for view in VIEWS:
        text = page.evaluate("view => ncsimViewer.svg(view)", view)
        names = {element.tag.rpartition("}")[2] for element in ElementTree.fromstring(text).iter()}
        assert names <= SHAPES
        assert not re.search(r"<[^>]* on\w+=", text)
        page.evaluate(
            "text => new Promise(done => { const i = new Image(); i.onload = i.onerror = done;"
            " i.src = URL.createObjectURL(new Blob([text], {type: 'image/svg+xml'})); })",
            text,
        )

    assert page.evaluate("window.hacked") is None
    assert page.locator("img").count() == 0
    assert page.locator("h1").inner_text() == HOSTILE
