"""``ncsim new``: whatever it writes loads and runs."""

import pytest
from ncsim_core.cli.main import main
from ncsim_core.scenario.loader import load_scenario


def ncsim(*args):
    with pytest.raises(SystemExit) as stop:
        main([str(each) for each in args])
    return stop.value.code


@pytest.mark.parametrize("name", ["first.yaml", "first.json"])
def test_the_starter_runs_as_it_is(name, tmp_path):
    path = tmp_path / name

    assert ncsim("new", path) == 0
    assert load_scenario(path).name == "first"
    assert ncsim("run", path) == 0


@pytest.mark.parametrize(
    "args",
    [
        ["--network", "grid", "-s", "network.rows=2", "-s", "network.columns=3"],
        ["--dags", "fft", "-s", "dags.points=4", "-s", "dags.compute_cost=10"],
        ["-s", "network.bandwidth_MBps=3", "-s", "interference=none", "-s", "seed=7"],
    ],
    ids=["network", "dags", "config"],
)
def test_what_generators_make_runs(args, tmp_path):
    path = tmp_path / "made.yaml"

    assert ncsim("new", path, *args) == 0
    assert load_scenario(path).name == "made"
    assert ncsim("run", path) == 0


def test_faults_of_generators_are_told_as_they_were_typed(tmp_path, capsys):
    path = tmp_path / "made.yaml"

    assert ncsim("new", path, "--network", "gird", "-s", "scheduller=heft") == 1
    told = capsys.readouterr().err
    assert "ncsim new  network.type: must be one of grid" in told
    assert "did you mean 'grid'?" in told
    assert ncsim("new", path, "-s", "scheduller=heft") == 1
    assert "ncsim new  config.scheduller: unknown key" in capsys.readouterr().err
    assert not path.exists()


def test_nothing_is_replaced(tmp_path, capsys):
    path = tmp_path / "made.yaml"
    path.write_text("mine", encoding="utf-8")

    assert ncsim("new", path) == 1
    assert path.read_text(encoding="utf-8") == "mine"
    assert "exists already" in capsys.readouterr().err


def test_each_missing_parameter_of_a_generator_is_told_once_with_what_it_is(tmp_path, capsys):
    assert ncsim("new", tmp_path / "x.yaml", "--network", "random_geometric") == 1

    assert capsys.readouterr().err.splitlines() == [
        "ncsim new  network: 'nodes' is missing: Nodes",
        "ncsim new  network: 'side_m' is missing: Side of the square, m",
        "ncsim new  network: 'range_m' is missing: Longest link, m",
    ]


FIELD = """
scenario:
  network:
    nodes:
      - {id: a, compute_capacity: 1, position: {x: 0, y: 0}}
      - {id: b, compute_capacity: 1, position: {x: 30, y: 0}}
      - {id: c, compute_capacity: 1, position: {x: 60, y: 0}}
    links: [{id: mine, from: a, to: b, bandwidth: 3}]
  dags: [{id: d, tasks: [{id: T, compute_cost: 1}]}]
  config: {scheduler: round_robin, link_model: wifi}
"""


def test_own_nodes_are_linked_up_to_a_range(tmp_path, capsys):
    (tmp_path / "field.yaml").write_text(FIELD)

    assert ncsim("new", tmp_path / "x.yaml", "--link", tmp_path / "field.yaml") == 1
    assert "--link needs --range" in capsys.readouterr().err
    args = ("--link", tmp_path / "field.yaml", "--range", "30", "-s", "seed=7")
    assert ncsim("new", tmp_path / "x.yaml", *args) == 0

    made = load_scenario(tmp_path / "x.yaml")
    links = made.network.links
    assert [each.id for each in links] == ["mine", "b_a", "b_c", "c_b"]
    assert links[0].bandwidth_MBps == 3.0
    assert made.config.seed == 7


def test_nodes_without_position_cannot_be_linked(tmp_path, capsys):
    (tmp_path / "field.yaml").write_text(FIELD.replace(", position: {x: 60, y: 0}", ""))

    args = ("--link", tmp_path / "field.yaml", "--range", "30")
    assert ncsim("new", tmp_path / "x.yaml", *args) == 1
    assert "nodes without position: c" in capsys.readouterr().err
