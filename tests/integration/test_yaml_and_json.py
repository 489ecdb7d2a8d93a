"""A scenario leaves the same bytes whether it was written in YAML or in JSON."""

import io
import json
from pathlib import Path

from hypothesis import given, settings
from ncsim_core.api import prepare
from ncsim_core.engine.setup import Limits
from ncsim_core.scenario.loader import load_scenario, parse_scenario
from ncsim_core.testing.scenario_strategies import scenarios
from ncsim_core.trace.writer import TraceWriter

GRID = Path(__file__).parents[2] / "examples" / "grid_4x4.yaml"


def trace_of(scenario):
    text = io.StringIO()
    prepare(scenario, limits=Limits(max_events=1000), observers=[TraceWriter(text)]).run()
    return text.getvalue()


@settings(max_examples=30)
@given(scenarios())
def test_yaml_and_json_leave_the_same_trace(document):
    from_json = parse_scenario(json.dumps(document))
    from_yaml = parse_scenario(from_json.to_yaml())

    assert trace_of(from_yaml) == trace_of(from_json)


def test_files_with_a_radio_leave_the_same_trace(tmp_path):
    path = tmp_path / "grid_4x4.json"
    scenario = load_scenario(GRID)
    path.write_text(json.dumps(scenario.to_document()), encoding="utf-8")

    assert trace_of(load_scenario(path)) == trace_of(scenario)
