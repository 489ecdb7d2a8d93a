import pytest
from ncsim_core.errors import ScenarioError
from ncsim_core.generators.amounts import Uniform
from ncsim_core.generators.catalogue import DAGS
from ncsim_core.generators.dags import (
    Workload,
    chain,
    dag_of,
    diamond,
    fft,
    fork_join,
    gaussian_elimination,
    layered_random,
    out_tree,
    paper_form,
)
from ncsim_core.generators.making import dags_from, depends_on_seed
from ncsim_core.generators.paper import paper_dag
from ncsim_core.generators.streams import Draws


def ends(form):
    """Return the tasks without feeders and those without followers."""
    fed = {target for _, target in form.edges}
    feeding = {source for source, _ in form.edges}
    return (
        [task for task in form.tasks if task not in fed],
        [task for task in form.tasks if task not in feeding],
    )


@pytest.mark.parametrize("tasks", [5, 10, 20])
def test_the_paper_form_is_the_dag_of_the_paper(tasks):
    made = dags_from({"type": "paper", "tasks": tasks, "payload_MB": 2}, Draws())

    assert made[0].dag == paper_dag(tasks, payload_MB=2.0, dag_id="dag_0")


def test_the_paper_has_no_dag_of_seven_tasks():
    with pytest.raises(ScenarioError, match="5, 10 or 20"):
        paper_form(7)


def test_a_chain_has_one_way_through():
    assert list(chain(3).edges) == [("T0", "T1"), ("T1", "T2")]


def test_a_fork_join_with_three_tasks_in_the_middle_is_the_small_dag_of_the_paper():
    assert set(fork_join(3).edges) == set(paper_form(5).edges)


def test_the_smallest_diamond_has_four_tasks():
    assert set(diamond(2).edges) == {("T0", "T1"), ("T0", "T2"), ("T1", "T3"), ("T2", "T3")}
    assert ends(diamond(5)) == (["T0"], ["T24"])


@pytest.mark.parametrize("seed", range(20))
def test_every_task_below_the_first_layer_is_fed_from_the_layer_above(seed):
    form = layered_random(Draws(seed), 4, 5, density=0.2)

    assert ends(form)[0] == [f"T{number}" for number in range(5)]
    assert all(int(t[1:]) // 5 == int(s[1:]) // 5 + 1 for s, t in form.edges)


@pytest.mark.parametrize(("density", "edges"), [(0.0, 15), (1.0, 75)])
def test_density_ranges_from_one_feeder_each_to_all(density, edges):
    assert len(layered_random(Draws(), 4, 5, density=density).edges) == edges


def test_an_out_tree_of_depth_three_has_fifteen_tasks():
    form = out_tree(3, 2)

    assert len(form.tasks) == 15
    assert len(form.edges) == 14
    assert ends(form)[0] == ["T0"]
    assert len(ends(form)[1]) == 8


@pytest.mark.parametrize("size", [2, 3, 5, 8])
def test_gaussian_elimination_has_the_number_of_tasks_of_the_literature(size):
    form = gaussian_elimination(size)

    assert len(form.tasks) == (size * size + size - 2) // 2
    assert ends(form) == (["P1"], [f"U{size - 1}_{size}"])


@pytest.mark.parametrize(("points", "tasks"), [(1, 1), (2, 5), (4, 15), (8, 39)])
def test_an_fft_has_the_number_of_tasks_of_the_literature(points, tasks):
    form = fft(points)

    assert len(form.tasks) == tasks
    assert ends(form)[0] == ["C0"]
    assert len(ends(form)[1]) == points


def test_each_last_butterfly_depends_on_every_leaf_of_the_calls():
    form = fft(8)
    feeders = {}
    for source, target in form.edges:
        feeders.setdefault(target, set()).add(source)

    def above(task):
        return {task}.union(*(above(each) for each in feeders.get(task, ())))

    assert {f"C{number}" for number in range(7, 15)} <= above("B2_0")


def test_an_fft_of_six_points_is_refused():
    with pytest.raises(ScenarioError, match="power of 2"):
        fft(6)


def test_drawing_payloads_does_not_change_costs():
    costs = Workload(compute_cost=Uniform(100, 900))
    both = Workload(compute_cost=Uniform(100, 900), payload_MB=Uniform(1, 9))
    one, other = (dag_of(chain(6), workload, Draws(4)) for workload in (costs, both))

    assert one.tasks == other.tasks
    assert one.dependencies != other.dependencies


def test_several_dags_of_a_scenario_have_draws_and_times_of_their_own():
    parameters = {"type": "layered_random", "layers": 4, "width": 4, "count": 3}
    made = dags_from(parameters | {"inject_every_s": 0.5}, Draws(1))

    assert [injection.at_us for injection in made] == [0, 500_000, 1_000_000]
    assert [injection.dag.id for injection in made] == ["dag_0", "dag_1", "dag_2"]
    assert len({injection.dag.dependencies for injection in made}) == 3


def test_more_dags_leave_the_first_ones_as_they_are():
    parameters = {"type": "chain", "tasks": 3, "compute_cost": {"low": 1, "high": 9}}
    few, many = (dags_from(parameters | {"count": count}, Draws(1)) for count in (2, 4))

    assert many[:2] == few


def test_every_form_knows_whether_the_seed_matters():
    samples = {
        "paper": {"tasks": 5},
        "chain": {"tasks": 3},
        "fork_join": {"width": 3},
        "diamond": {"size": 3},
        "layered_random": {"layers": 4, "width": 5},
        "out_tree": {"depth": 2, "branching": 2},
        "gaussian_elimination": {"size": 4},
        "fft": {"points": 4},
    }
    assert samples.keys() == DAGS.keys()
    for name, given in samples.items():
        for more in ({}, {"payload_MB": {"low": 1, "high": 2}}):
            parameters = {"type": name, **given, **more}
            differs = dags_from(parameters, Draws(1)) != dags_from(parameters, Draws(2))
            assert depends_on_seed(parameters, DAGS) == differs
