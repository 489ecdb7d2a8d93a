import gc
import json
import subprocess
import sys
import time

import pytest
from ncsim_core.network import Link, Node, Position
from ncsim_core.registry import Registry
from ncsim_core.scenario import ScenarioFaults, load_scenario, parse_scenario
from ncsim_core.workflow import Dependency, Task

FULL = """
# yaml-language-server: $schema=../schemas/scenario.schema.json
scenario:
  name: two-hop demo
  description: optional text
  network:
    nodes:
      - {id: n0, compute_capacity: 5e2, position: {x: 0, y: -1.5}}
      - {id: yes, compute_capacity: .5}
    links:
      - {id: 12:30, from: n0, to: yes, bandwidth: 2, latency: 1e-3, medium: wired}
      - {id: 2026-08-02, from: n0, to: yes, bandwidth: 0}
  dags:
    - id: 017
      inject_at: 0.25
      tasks: [{id: T0, compute_cost: 0, pinned_to: n0}, {id: T1, compute_cost: 7}]
      edges: [{from: T0, to: T1, data_size: 10}]
    - {id: second, tasks: [{id: T0, compute_cost: 1}]}
  config: {seed: 7, scheduler: round_robin, queue: {type: fifo}, routing: ncsim-core/direct}
"""


@pytest.fixture
def full(core: Registry):
    return parse_scenario(FULL, registry=core)


def test_nodes_and_links_are_read_as_written(full):
    assert full.network.nodes == (
        Node("n0", 500.0, Position(0.0, -1.5)),
        Node("yes", 0.5),
    )
    assert full.network.links == (
        Link("12:30", "n0", "yes", 2.0, 0.001, "wired"),
        Link("2026-08-02", "n0", "yes", 0.0),
    )


def test_dags_are_read_with_their_times_in_microseconds(full):
    first, second = full.injections

    assert (first.at_us, first.dag.id, second.at_us) == (250_000, "017", 0)
    assert first.dag.tasks == (Task("T0", 0.0, "n0"), Task("T1", 7.0))
    assert first.dag.dependencies == (Dependency("T0", "T1", 10.0),)


def test_config_is_read_and_completed(full):
    names = {kind: spec.name for kind, spec in full.config.components.items()}

    assert (full.name, full.description, full.config.seed) == ("two-hop demo", "optional text", 7)
    assert names == {
        "scheduler": "round_robin",
        "routing_model": "ncsim-core/direct",
        "link_model": "static",
        "interference_model": "none",
        "queue_model": "fifo",
        "dag_source": "multi",
    }


def test_a_byte_order_mark_and_windows_line_ends_are_fine(core: Registry, tmp_path, full):
    path = tmp_path / "windows.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + FULL.replace("\n", "\r\n").encode())

    assert load_scenario(path, registry=core) == full


def test_json_is_read_wherever_yaml_is(core: Registry, tmp_path, full):
    text = json.dumps({"$schema": "scenario.schema.json", **full.to_document()})
    for name in ("scenario.json", "scenario.yaml"):
        (tmp_path / name).write_text(text)

        assert load_scenario(tmp_path / name, registry=core) == full


def test_parsing_leaves_the_document_alone(core: Registry, full):
    document = full.to_document()
    before = json.dumps(document)

    parse_scenario(document, {"seed": 3, "queue.options": {}}, registry=core)

    assert json.dumps(document) == before


def test_a_native_file_is_loaded_without_notes(full):
    assert full.notes == ()


def test_a_chain_of_ten_thousand_tasks_loads_in_seconds(core: Registry):
    tasks = "".join(f"        - {{id: T{i}, compute_cost: 5e2}}\n" for i in range(10_000))
    edges = "".join(f"        - {{from: T{i}, to: T{i + 1}, data_size: 1}}\n" for i in range(9_999))
    text = (
        "scenario:\n  network: {nodes: [{id: n, compute_capacity: 1}]}\n"
        f"  dags:\n    - id: d\n      tasks:\n{tasks}      edges:\n{edges}"
    )

    began = time.process_time()
    scenario = parse_scenario(text, registry=core)

    assert len(scenario.injections[0].dag.tasks) == 10_000
    assert time.process_time() - began < 10  # 1 s on an idle machine


def test_a_good_scenario_loads_without_jsonschema_and_numpy(tmp_path):
    path = tmp_path / "good.yaml"
    path.write_text(FULL)
    code = (
        "import sys; from ncsim_core.scenario.loader import load_scenario;"
        f"load_scenario({str(path)!r}); print({{'jsonschema', 'numpy'}} & set(sys.modules))"
    )

    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    assert run.stdout.strip() == "set()"


def test_loading_leaves_the_garbage_collector_as_it_was(core: Registry, full):
    text = full.to_yaml()

    for is_enabled in (False, True):
        (gc.enable if is_enabled else gc.disable)()
        parse_scenario(text, registry=core)
        assert gc.isenabled() is is_enabled
        with pytest.raises(ScenarioFaults):
            parse_scenario("scenario: {}", registry=core)
        assert gc.isenabled() is is_enabled


def test_nodes_without_any_link_are_noted_where_data_would_have_to_travel():
    text = """
scenario:
  network: {nodes: [{id: a, compute_capacity: 1}, {id: b, compute_capacity: 1}]}
  dags:
    - id: d
      tasks: [{id: T0, compute_cost: 1}, {id: T1, compute_cost: 1}]
      edges: [{from: T0, to: T1, data_size: 4}]
  config: {scheduler: all_on_fastest}
"""
    lonely = text.replace(", {id: b, compute_capacity: 1}", "")
    linked = text.replace("}]}", "}], links: [{id: ab, from: a, to: b, bandwidth: 1}]}")

    (note,) = parse_scenario(text).notes
    assert note.startswith("there are no links; ncsim new OUT --link FILE")
    assert parse_scenario(lonely).notes == parse_scenario(linked).notes == ()
