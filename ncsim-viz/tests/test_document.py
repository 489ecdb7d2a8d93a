import gzip
import json

import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.trace.embedding import traces_in
from ncsim_core.trace.records import TraceError
from ncsim_viz import commands
from ncsim_viz.document import report_html

HEADER = {
    "format": "ncsim-trace", "version": "1.0", "time_unit": "us", "level": "full", "software": "x",
    "scenario": "</script><img src=x onerror=alert(1)>", "scenario_sha256": "", "seed": 1,
    "plugins": {}, "sections": {}, "nodes": [["</script><b>", 1.0, None, None]], "links": [],
    "kinds": {},
}  # fmt: skip


@pytest.fixture
def trace(tmp_path):
    path = tmp_path / "trace.jsonl"
    path.write_text(json.dumps(HEADER) + "\n", encoding="utf-8")
    return path


def test_the_report_holds_the_trace_byte_for_byte(trace):
    assert traces_in(report_html(trace)) == [trace.read_bytes()]


def test_a_compressed_trace_is_embedded_as_it_is(trace, tmp_path):
    packed = tmp_path / "other.jsonl.gz"
    packed.write_bytes(gzip.compress(trace.read_bytes(), mtime=0))

    assert traces_in(report_html(packed)) == [trace.read_bytes()]


def test_equal_runs_give_equal_reports(trace):
    assert report_html(trace) == report_html(trace)


def test_a_second_run_is_embedded_too(trace):
    assert len(traces_in(report_html(trace, trace))) == 2


def test_a_hostile_name_stays_text(trace):
    page = report_html(trace)

    assert "<img src=x" not in page
    assert page.count("</script>") == 4  # the trace, what accompanies it, the viewer, its loader


def test_the_viewer_names_no_host(trace):
    page = report_html(trace).replace("http://www.w3.org/", "")  # names of dialects

    assert "http://" not in page
    assert "https://" not in page


def test_what_is_no_trace_is_refused(tmp_path):
    path = tmp_path / "trace.jsonl"
    path.write_text("{}\n")

    with pytest.raises(TraceError):
        report_html(path)


def test_a_report_is_not_replaced_unless_asked(trace, tmp_path):
    out = tmp_path / "report.html"
    commands.view(trace, out)

    with pytest.raises(ScenarioError, match="--force"):
        commands.view(trace, out)
    commands.view(trace, out, force=True)
