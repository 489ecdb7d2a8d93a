import json
import re
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.cli.main import exit_code_of
from ncsim_core.cli.verbs import app
from ncsim_core.errors import ScenarioError
from ncsim_core.trace.loading import load_run
from ncsim_viz.figures import dag, gantt, rates, topology

pytest.importorskip("matplotlib", reason="no matplotlib: pip install 'ncsim-viz[plots]'")

FIGURES = {"dag": dag, "gantt": gantt, "rates": rates, "topology": topology}
MAGIC = {".png": b"\x89PNG", ".pdf": b"%PDF", ".svg": b"<?xml"}


def plot(*arguments):
    return exit_code_of(lambda: app(args=["plot", *map(str, arguments)], standalone_mode=False))


def words_in(path):
    """Return the texts of an SVG picture."""
    return re.findall(r"<text[^>]*>([^<]*)</text>", path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("suffix", MAGIC)
@pytest.mark.parametrize("kind", FIGURES)
def test_each_figure_is_written_in_each_form(run_folder, tmp_path, kind, suffix):
    picture = tmp_path / f"picture{suffix}"

    assert plot(run_folder, "--kind", kind, "-o", picture) == 0
    assert picture.read_bytes().startswith(MAGIC[suffix])


@pytest.mark.parametrize("kind", FIGURES)
def test_equal_runs_give_equal_pictures(run_folder, tmp_path, kind):
    run = load_run(run_folder)
    pictures = [tmp_path / "a.svg", tmp_path / "b.svg"]
    for picture in pictures:
        FIGURES[kind].draw(run, picture)

    assert pictures[0].read_bytes() == pictures[1].read_bytes()


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("gantt", {"a", "a sends", "A -&gt; C", "D", "task", "transfer"}),
        ("rates", {"A -&gt; C", "B -&gt; D", "rate alone", "another starts", "another ends"}),
        ("topology", {"a", "b", "c", "carried (MB)"}),
        ("dag", {"A", "B", "C", "D", "example"}),
    ],
)
def test_figures_name_what_they_show(run_folder, tmp_path, kind, words):
    FIGURES[kind].draw(load_run(run_folder), tmp_path / "x.svg")

    assert words <= set(words_in(tmp_path / "x.svg"))


@pytest.mark.parametrize("kind", FIGURES)
@pytest.mark.parametrize("name", ["$x^{", "</text><script>", "\x1b[1m", "ü 漢 🙂"])
@pytest.mark.filterwarnings("ignore:Glyph")
def test_names_are_never_taken_for_anything_else(run_folder, tmp_path, kind, name):
    trace = run_folder / "trace.jsonl"
    for old in ('"a"', '"A"', '"example"'):
        trace.write_text(trace.read_text().replace(old, json.dumps(name)))

    FIGURES[kind].draw(load_run(run_folder), tmp_path / "x.svg")

    assert "<script" not in (tmp_path / "x.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize("kind", ["gantt", "topology", "dag"])
def test_a_run_that_was_torn_off_is_drawn_as_far_as_it_went(run_folder, tmp_path, kind):
    trace = run_folder / "trace.jsonl"
    lines = trace.read_text().splitlines(keepends=True)
    for kept in (7, len(lines) // 2):
        trace.write_text("".join(lines[:kept]) + '{"t":')
        FIGURES[kind].draw(load_run(run_folder), tmp_path / "x.svg")


@pytest.mark.parametrize("figure", [dag, topology])
def test_what_is_too_large_for_names_is_drawn_without(run_folder, tmp_path, monkeypatch, figure):
    monkeypatch.setattr(figure, "NAMED_UP_TO", 1)

    figure.draw(load_run(run_folder), tmp_path / "x.svg")

    assert not {"A", "a"} & set(words_in(tmp_path / "x.svg"))


def test_what_cannot_be_drawn_is_said(run_folder, tmp_path, capsys):
    trace = run_folder / "trace.jsonl"
    text = trace.read_text()
    trace.write_text(text.replace('"level":"full"', '"level":"coarse"'))
    with pytest.raises(ScenarioError, match="--trace full"):
        rates.draw(load_run(run_folder), tmp_path / "x.svg")
    trace.write_text(text.splitlines(keepends=True)[0])
    for figure, why in ((rates, "no transfer"), (dag, "no DAG"), (gantt, "nothing")):
        with pytest.raises(ScenarioError, match=why):
            figure.draw(load_run(run_folder), tmp_path / "x.svg")
    assert plot(run_folder, "-o", tmp_path / "x.svg") == 1
    assert "give --kind; figures of runs: dag, gantt, rates, topology" in capsys.readouterr().err
    assert plot(run_folder, "--kind", "gant", "-o", tmp_path / "x.svg") == 1
    assert "'gant': unknown" in capsys.readouterr().err
    assert not (tmp_path / "x.svg").exists()


def test_the_area_below_a_staircase_is_the_payload_and_no_step_lasts_no_time(
    scenario_text, tmp_path
):
    scenario, out = tmp_path / "x.yaml", tmp_path / "out"
    scenario.write_text(
        scenario_text.replace("      edges: [", "      edges: [{from: T2, to: T1, data_size: 1}, ")
        .replace("tasks: [", "tasks: [{id: T2, compute_cost: 0, pinned_to: a}, ")
        .replace("T0, compute_cost: 1", "T0, compute_cost: 0")
    )
    exit_code_of(lambda: app(args=["run", str(scenario), "-o", str(out)], standalone_mode=False))
    run = load_run(out)
    replaced_at_once = 0
    for transfer in run.transfers:
        spans = rates.in_force(transfer, run)
        replaced_at_once += len(transfer.steps) - len(spans)

        assert all(end_us > step.at_us for step, end_us in spans)
        served_MB = sum(step.rate_MBps * (end_us - step.at_us) / 1e6 for step, end_us in spans)
        assert served_MB == pytest.approx(transfer.size_MB)
    assert replaced_at_once


@given(st.integers(1, 12), st.data())
def test_layers_follow_every_edge_and_no_two_tasks_share_a_place(count, data):
    pairs = [(a, b) for b in range(count) for a in range(b)]
    edges = data.draw(st.lists(st.sampled_from(pairs), unique=True)) if pairs else []

    places = dag.layered(range(count), edges)

    assert all(places[a][0] < places[b][0] for a, b in edges)
    assert len(set(places.values())) == count
    assert all(a < b for a, b in pairwise(sorted({x for x, _ in places.values()})))
