import pytest
from ncsim_core.testing.fixtures import fake_dist
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.records import TraceHeader
from ncsim_core.trace.writer import TraceWriter

__all__ = ["fake_dist"]


@pytest.fixture
def run_folder(tmp_path):
    """Return the folder of the paper's worked example: two transfers that share a link."""
    folder = tmp_path / "out"
    folder.mkdir()
    worked_example(TraceWriter(folder / "trace.jsonl", TraceHeader("example"))).run()
    return folder


@pytest.fixture
def scenario_text():
    """Return a small scenario."""
    return """
scenario:
  name: small
  network:
    nodes: [{id: a, compute_capacity: 1}, {id: b, compute_capacity: 2}]
    links: [{id: ab, from: a, to: b, bandwidth: 2}]
  dags:
    - id: d
      tasks: [{id: T0, compute_cost: 1, pinned_to: a}, {id: T1, compute_cost: 1, pinned_to: b}]
      edges: [{from: T0, to: T1, data_size: 4}]
  config: {scheduler: manual, link_model: static}
"""
