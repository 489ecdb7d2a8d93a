import pytest
from ncsim_core.testing.worked_example import worked_example
from ncsim_core.trace.records import TraceHeader
from ncsim_core.trace.writer import TraceWriter


@pytest.fixture
def example_trace(tmp_path):
    """The trace file of Appendix B's example."""
    path = tmp_path / "trace.jsonl"
    worked_example(TraceWriter(path, TraceHeader("example", "cafe", 7))).run()
    return path
