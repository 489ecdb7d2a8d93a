"""Wrong sweep files: every fault is told where it is, before anything runs."""

import pytest
from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.sweep.reading import load_sweep

GOOD = """\
sweep:
  name: first
  base:
    network: {type: random_geometric, nodes: 6, side_m: 80, range_m: 60, bandwidth_MBps: 1}
    dags: {type: fork_join, width: 4}
    config: {link_model: static, routing: minimum_hop}
  vary:
    scheduler: [round_robin, all_on_fastest]
    dags.payload_MB: {from: 5, to: 15, step: 5}
  where: "payload_MB > 5 or scheduler == 'round_robin'"
  replicate: {seeds: 10}
  limits: {wall_s: 60}
"""

BAD = [
    ("sweep:\n  name", "swep:\n  name", "1:1", "did you mean 'sweep'"),
    ("  base:", "  bas:", "3:3", "did you mean 'base'"),
    ("random_geometric", "random_geometrc", "4:21", "did you mean 'random_geometric'"),
    ("nodes: 6", "nodes: ten", "4:46", "must be a whole number, not the text 'ten'"),
    ("nodes: 6", "nodes: 0", "4:46", "must be at least 1, not 0"),
    ("range_m: 60", "range: 60", "4:61", "did you mean 'range_m'"),
    ("range_m: 60", "range_m: 6", "4:14", "raise range_m (it is 6)"),
    ("{type: fork_join, width: 4}", "{type: fft, points: 5}", "5:11", "power of 2 points, not 5"),
    ("{type: fork_join, width: 4}", "{file: none.yaml}", "5:18", "no such file"),
    ("link_model: static", "link_model: radio", "6:26", "unknown link_model 'radio'"),
    (", bandwidth_MBps: 1", "", "4:5", "links without bandwidth"),
    ("ting: minimum_hop", "ting: minimum_hops", "6:43", "did you mean 'minimum_hop'"),
    ("routing:", "ruting:", "6:34", "did you mean 'routing'"),
    ("[round_robin, all", "[round_robn, all", "8:17", "did you mean 'round_robin'"),
    ("[round_robin, all_on_fastest]", "round_robin", "8:16", "must be a list"),
    ("[round_robin, all_on_fastest]", "[]", "8:16", "needs at least 1"),
    ("all_on_fastest]", "round_robin]", "8:30", "'round_robin' is listed twice"),
    ("    scheduler:", "    schedulr:", "8:5", "did you mean 'scheduler'"),
    ("    scheduler:", "    seed: [1, 2]\n    scheduler:", "8:11", "replicate.seeds"),
    ("dags.payload_MB:", "dags.payload:", "9:5", "did you mean 'payload_MB'"),
    ("dags.payload_MB:", "dag.payload_MB:", "9:5", "did you mean 'dags'"),
    ("{from: 5, to: 15, step: 5}", "[5, -1]", "9:26", "must be at least 0, not -1"),
    ("{from: 5, to: 15, step: 5}", "[5, x]", "9:26", "must be a number, not the text 'x'"),
    ("{from: 5, to: 15, step: 5}", "{from: 5, too: 15}", "9:32", "did you mean 'to'"),
    ("step: 5}", "step: -5}", "9:22", "a step of -5 does not lead from 5 to 15"),
    ("step: 5}", "step: 5, count: 2}", "9:22", "a step or a count, not both"),
    ("step: 5}", "scale: log}", "9:22", "a scale needs a count"),
    ("payload_MB > 5", "payload > 5", "10:10", "'payload' is not varied"),
    ("payload_MB > 5", "payload_MB >> 5", "10:10", "'payload_MB >> 5' is not allowed"),
    ("payload_MB > 5 or", "scheduler > 5 or", "10:10", "does not fit the values"),
    ("MB > 5 or scheduler == 'round_robin'", "MB > 50", "10:10", "no combination of values meets"),
    ("seeds: 10", "seeds: -1", "11:22", "must be at least 1, not -1"),
    ("seeds: 10", "seed: 10", "11:15", "did you mean 'seeds'"),
    ("seeds: 10", "seeds: 10, pair: [schedler]", "11:33", "did you mean 'scheduler'"),
    ("wall_s: 60", "wall: 60", "12:12", "did you mean 'wall_s'"),
    ("wall_s: 60", "wall_s: 0", "12:20", "must be greater than 0, not 0"),
    ("wall_s: 60", "wall_s: .nan", "12:20", "must be a finite number, not nan"),
    ("wall_s: 60", "memory_MB: .inf", "12:23", "must be a finite number, not inf"),
    ("wall_s: 60}", "wall_s: 60", "13:1", "not valid YAML"),
    ("  vary:", "  zip: [{seed: [1, 2], queue: [fifo]}]\n  vary:", "7:9", "not 2, 1"),
    ("  vary:", "  zip: [{scheduler: [manual]}]\n  vary:", "7:10", "'scheduler' is varied twice"),
    ("  vary:", "  zip: [{queue: [fifo, fifo]}]\n  vary:", "7:24", "'fifo' is listed twice"),
]


def loaded(tmp_path, text):
    path = tmp_path / "study.yaml"
    path.write_text(text)
    return load_sweep(path)


@pytest.mark.parametrize(("old", "new", "place", "message"), BAD, ids=[each[1] for each in BAD])
def test_a_fault_is_told_where_it_is(tmp_path, old, new, place, message):
    assert old in GOOD
    text = GOOD.replace(old, new, 1)
    with pytest.raises(ScenarioFaults) as caught:
        loaded(tmp_path, text)

    told = {f"{each.line}:{each.column}": each.render() for each in caught.value.faults}
    assert place in told, told
    assert message in told[place]


def test_the_good_one_is_good(tmp_path):
    assert len(list(loaded(tmp_path, GOOD).runs())) == 10 * (3 + 2)


def test_a_scenario_in_place_of_a_sweep_is_told_apart(tmp_path):
    with pytest.raises(ScenarioFaults, match=r"study\.yaml:1:1 .*ncsim run takes it"):
        loaded(tmp_path, "scenario: {}\n")


def test_all_faults_are_told_at_once(tmp_path):
    text = GOOD.replace("scheduler: [", "schedulr: [").replace("routing:", "ruting:")
    with pytest.raises(ScenarioFaults) as caught:
        loaded(tmp_path, text)

    assert [each.line for each in caught.value.faults] == [6, 8, 10]
