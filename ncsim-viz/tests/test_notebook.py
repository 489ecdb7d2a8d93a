import json
import re
from html import unescape

import ncsim_viz
import pytest
from ncsim_core.api import result_of
from ncsim_core.scenario.loader import parse_scenario
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.embedding import traces_in
from ncsim_viz import show

FORMS = {"text/plain", "image/svg+xml", "text/html"}


def test_a_run_has_three_forms(run_folder):
    bundle = show(run_folder)._repr_mimebundle_(include=None, exclude=None)  # as IPython asks

    assert bundle.keys() == FORMS
    assert "example: completed" in bundle["text/plain"]
    assert bundle["image/svg+xml"].startswith("<svg")


def test_the_frame_holds_the_report_and_cannot_touch_the_notebook(run_folder):
    html = show(run_folder)._repr_mimebundle_()["text/html"]

    report = unescape(re.search(r'srcdoc="([^"]*)"', html)[1])
    assert traces_in(report) == [(run_folder / "trace.jsonl").read_bytes()]
    assert "allow-same-origin" not in html
    assert html.count("<") == 2  # the frame only; all else is escaped


def test_a_front_end_may_choose(run_folder):
    view = show(run_folder)

    assert view._repr_mimebundle_(include={"text/plain"}).keys() == {"text/plain"}
    assert view._repr_mimebundle_(exclude={"text/html"}).keys() == FORMS - {"text/html"}


def test_a_result_has_a_picture_and_a_text(run_folder):
    simulation = worked_example()
    simulation.run()

    bundle = show(result_of(simulation))._repr_mimebundle_()

    assert bundle.keys() == FORMS - {"text/html"}


def test_a_scenario_is_run(scenario_text):
    view = show(parse_scenario(scenario_text), scheduler="round_robin")

    trace = traces_in(view.report)[0].splitlines()
    assert json.loads(trace[0])["plugins"]["scheduler"]["name"] == "round_robin"
    assert json.loads(trace[-1])["status"] == "completed"


def test_only_what_is_offered_is_there():
    with pytest.raises(AttributeError, match="no attribute 'shows'"):
        _ = ncsim_viz.shows
