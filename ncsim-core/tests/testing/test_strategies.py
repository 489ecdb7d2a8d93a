"""What the strategies draw is valid, and varied enough to matter."""

from hypothesis import find, given, settings
from hypothesis import strategies as st
from jsonschema import Draft7Validator
from ncsim_core.testing import strategies
from ncsim_core.testing.builders import rated
from ncsim_core.testing.oracle import all_routes
from ncsim_core.testing.scenario_strategies import scenarios

few = settings(max_examples=30, derandomize=True, database=None, deadline=None)

SCHEMA = {
    "type": "object",
    "additionalProperties": False,
    "required": ["must"],
    "properties": {
        "must": {"type": "integer", "minimum": 3, "maximum": 5},
        "open": {"type": "number", "exclusiveMinimum": 0, "default": 1.0},
        "below": {"type": "number", "maximum": -2},
        "mode": {"enum": ["a", "b"], "default": "a"},
        "flag": {"type": "boolean"},
        "names": {"type": "array", "items": {"type": "string"}, "minItems": 1},
        "maybe": {"type": ["integer", "null"], "minimum": 1, "default": None},
        "code": {"type": "string", "pattern": "^[a-c]{2}$"},
        "either": {"anyOf": [{"const": "auto"}, {"type": "integer"}]},
        "inner": {"type": "object", "properties": {"k": {"type": "integer"}}},
    },
}


@few
@given(options=strategies.options_for(SCHEMA))
def test_drawn_options_are_valid(options):
    Draft7Validator(SCHEMA).validate(options)


def test_every_option_is_drawn_sooner_or_later():
    seen: set[str] = set()

    @few
    @given(options=strategies.options_for(SCHEMA))
    def collect(options):
        seen.update(options)

    collect()

    assert seen == set(SCHEMA["properties"])


def found(strategy, condition):
    steady = settings(max_examples=2000, derandomize=True, database=None)
    return find(strategy, condition, settings=steady)


@few
@given(network=strategies.networks(max_nodes=4, max_links=6))
def test_networks_keep_within_their_limits(network):
    assert 1 <= len(network.nodes) <= 4
    assert len(network.links) <= 6


def test_networks_include_what_is_easily_forgotten():
    def twins(network):
        pairs = [(link.source, link.target) for link in network.links]
        return len(pairs) > len(set(pairs))

    found(strategies.networks(), lambda network: len(network.nodes) == 1)
    found(strategies.networks(), lambda network: len(network.nodes) > 2 and not network.links)
    found(strategies.networks(), lambda network: 0.0 in rated(network).bandwidth_MBps)
    found(strategies.networks(), twins)
    found(
        strategies.networks(),
        lambda network: (
            len(list(all_routes(0, 1, rated(network)))) > 1 if len(network.nodes) > 1 else False
        ),
    )


@few
@given(case=strategies.instances(), data=st.data())
def test_dags_are_pinned_to_nodes_of_their_network(case, data):
    pins = {task.pinned_to for task in case.dag.tasks} - {None}

    assert pins <= set(case.network.node_index)


@few
@given(document=scenarios())
def test_scenarios_are_plain_data_of_the_published_form(document):
    body = document["scenario"]

    assert set(body) == {"name", "network", "dags", "config"}
    assert body["dags"]
    assert all(set(dag) == {"inject_at", "id", "tasks", "edges"} for dag in body["dags"])


@few
@given(case=strategies.busy_runs())
def test_busy_runs_send_along_one_link_each(case):
    [injection] = case.injections
    linked = {(link.source, link.target) for link in case.network.links}
    places = {task.id: task.pinned_to for task in injection.dag.tasks}

    assert all(
        (places[each.source], places[each.target]) in linked for each in injection.dag.dependencies
    )
