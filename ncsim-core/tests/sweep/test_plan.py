import pytest
from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.sweep.plan import plan_from_json
from ncsim_core.sweep.reading import load_sweep
from ncsim_core.sweep.resolving import Resolver
from ncsim_core.sweep.running import run_sweep
from ncsim_core.sweep.store import Store
from ncsim_core.sweep.table import table_of
from ncsim_core.sweep.where import ConditionError, condition

BASE = {
    "network": {
        "type": "random_geometric",
        "nodes": 5,
        "side_m": 50,
        "range_m": 80,
        "bandwidth_MBps": 2,
    },
    "dags": {"type": "layered_random", "layers": 3, "width": 2},
    "config": {"scheduler": "round_robin", "link_model": "static"},
}


def plan(vary=None, **more):
    return load_sweep({"sweep": {"base": BASE, "vary": vary or {}, **more}})


def scenarios(a_plan):
    resolver = Resolver(a_plan)
    return {(run.values, run.seed): resolver.scenario(run) for run in a_plan.runs()}


def test_all_combinations_are_run_once_and_numbered_in_file_order():
    vary = {"queue": ["fifo"], "network.nodes": [4, 5], "network.latency_s": [0, 1]}
    runs = list(plan(vary, replicate={"seeds": 3}).runs())

    assert sorted(run.number for run in runs) == list(range(12))
    by_number = sorted(runs)
    assert [run.values for run in by_number[::3]] == [
        ("fifo", 4, 0),
        ("fifo", 4, 1),
        ("fifo", 5, 0),
        ("fifo", 5, 1),
    ]
    assert [run.seed for run in by_number[:3]] == [1, 2, 3]


def test_zipped_lists_are_walked_together():
    runs = plan(zip=[{"network.nodes": [3, 4], "network.side_m": [30, 40]}]).runs()

    assert [run.values for run in runs] == [(3, 30), (4, 40)]


def test_conditions_choose_runs():
    chosen = plan({"network.nodes": [3, 4, 5]}, where="nodes >= 4 and nodes % 2 == 0").runs()

    assert [run.values for run in chosen] == [(4,)]


@pytest.mark.parametrize(
    "text",
    ["open('x')", "().__class__", "[n for n in (1,)]", "x", "n ** 9", "(lambda: 1)()", "n +"],
)
def test_a_condition_can_do_nothing_but_compare(text):
    with pytest.raises(ConditionError):
        condition(text, ["n"])({"n": 1})


def test_text_cannot_be_multiplied_in_a_condition():
    with pytest.raises(ConditionError, match="is no number"):
        condition("'a' * n == 'b'", ["n"])({"n": 10**9})


def test_all_policies_of_a_seed_see_the_same_draws():
    found = scenarios(
        plan({"queue": ["fifo"], "network.latency_s": [0, 1]}, replicate={"seeds": 2})
    )

    for seed in (1, 2):
        one, other = (found[("fifo", latency), seed] for latency in (0, 1))
        assert [n.position for n in one.network.nodes] == [n.position for n in other.network.nodes]
        assert one.injections == other.injections


def test_unpaired_columns_have_draws_of_their_own():
    vary = {"queue": ["fifo", "ncsim-core/fifo"], "network.latency_s": [0, 1]}
    found = scenarios(plan(vary, replicate={"seeds": [1], "pair": ["queue"]}))
    nodes = {values: each.network.nodes for (values, _), each in found.items()}

    assert nodes["fifo", 0] == nodes["ncsim-core/fifo", 0]
    assert nodes["fifo", 0] != nodes["fifo", 1]


def test_a_plan_survives_the_way_to_a_worker():
    a_plan = plan({"network.nodes": [3, 4]}, limits={"wall_s": 9}, replicate={"seeds": 2})
    again = plan_from_json(a_plan.to_json())

    assert again == a_plan
    assert list(again.runs()) == list(a_plan.runs())


@pytest.mark.parametrize(
    ("line", "column", "text", "old", "new"),
    [
        (6, 23, "did you mean 'round_robin'", "[round_robin]", "[round_robbin]"),
        (3, 34, "'leaves' is missing", "nodes: 4, ", ""),
        (6, 5, "seeds are not varied", "scheduler:", "seed:"),
        (7, 10, "'x' is not varied", "true", "x"),
    ],
)
def test_faults_have_line_and_column(tmp_path, line, column, text, old, new):
    del column
    path = tmp_path / "sweep.yaml"
    good = (
        "sweep:\n  base:\n    network: {type: line, nodes: 4, bandwidth_MBps: 1}\n"
        "    dags: {type: chain, tasks: 2}\n  vary:\n    scheduler: [round_robin]\n"
        '  where: "true"\n'
    )
    load_sweep_text(path, good)
    with pytest.raises(ScenarioFaults) as caught:
        load_sweep_text(path, good.replace(old, new))

    assert caught.value.faults[0].line == line
    assert text.replace("leaves", "nodes") in str(caught.value)


def load_sweep_text(path, text):
    path.write_text(text)
    return load_sweep(path)


def test_extending_a_study_reuses_what_is_there(tmp_path):
    def done(nodes):
        vary = {"network.nodes": nodes}
        sweep = {"sweep": {"base": BASE, "vary": vary, "replicate": {"seeds": 3}}}
        with run_sweep(sweep, tmp_path / "study", executor="serial") as results:
            return results.table()

    few, many = done([3, 4]), done([3, 4, 5])

    assert many.rows[:6] == few.rows  # wall times too: they were not run again
    assert len(many.rows) == 9


@pytest.mark.parametrize("folder", ["study", None])
def test_a_walk_that_was_left_half_way_is_finished_by_the_next(tmp_path, folder):
    sweep = {"sweep": {"base": BASE, "replicate": {"seeds": 30}}}
    place = None if folder is None else tmp_path / folder
    with run_sweep(sweep, place, executor="serial") as results:
        first = next(iter(results))
        rows = results.table().to_dicts()
        again = list(results)

    assert first["seed"] == 1
    assert [row["seed"] for row in rows] == list(range(1, 31))
    assert None not in {row["status"] for row in rows}
    assert len(again) == 30


def test_shards_merge_into_the_whole(tmp_path):
    sweep = {"sweep": {"base": BASE, "replicate": {"seeds": 7}}}
    for number in (1, 2, 3):
        folder = tmp_path / f"part-{number}"
        with run_sweep(sweep, folder, executor="serial", shard=(number, 3)) as results:
            results.table()
    with Store(tmp_path / "whole") as whole:
        for number in (1, 2, 3):
            with Store(tmp_path / f"part-{number}", must_exist=True) as part:
                whole.merge(part)
                whole.merge(part)
        table = table_of(whole)

    assert [row["seed"] for row in table.to_dicts()] == list(range(1, 8))
    assert {row["status"] for row in table.to_dicts()} <= {"completed", "unroutable"}
