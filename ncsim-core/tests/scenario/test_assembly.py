import pytest
from ncsim_core.builtin.dag_sources import SingleDAGSource
from ncsim_core.builtin.interference_models import NoInterference
from ncsim_core.builtin.link_models import StaticLinkModel
from ncsim_core.builtin.queue_models import FifoQueue
from ncsim_core.builtin.routing_models import DirectRouting
from ncsim_core.builtin.schedulers import RoundRobinScheduler
from ncsim_core.errors import PluginError
from ncsim_core.network import LinkRates
from ncsim_core.registry import Registry
from ncsim_core.scenario import assemble, parse_scenario
from ncsim_core.scenario.assembly import link_rates_fault

PLAIN = """
scenario:
  network:
    nodes: [{id: a, compute_capacity: 1}, {id: b, compute_capacity: 1}]
    links: [{id: ab, from: a, to: b, bandwidth: 1}]
  dags: [{id: d, tasks: [{id: x, compute_cost: 1}]}]
  config: {scheduler: round_robin}
"""


def scenario(registry, config="{}"):
    text = (
        "scenario: {network: {nodes: [{id: n, compute_capacity: 1, position: {x: 0, y: 0}}, "
        "{id: m, compute_capacity: 1, position: {x: 1, y: 0}}], "
        "links: [{id: l, from: n, to: m, bandwidth: 8, latency: 0.25}]}, "
        f"dags: [{{id: d, tasks: [{{id: t, compute_cost: 1}}]}}], config: {config}}}"
    )
    return parse_scenario(text, registry=registry)


def test_the_network_gets_the_rates_of_its_link_model(core: Registry, with_antenna: Registry):
    plain = assemble(scenario(core), core).network
    radio = assemble(scenario(with_antenna, "{air: {}}"), with_antenna).network

    assert (plain.bandwidth_MBps, plain.latency_s) == ((8.0,), (0.25,))
    assert (radio.bandwidth_MBps, radio.latency_s) == ((4.0,), (0.5,))


def test_all_six_components_are_built_and_named(core: Registry):
    models = assemble(scenario(core), core).models

    assert isinstance(models.scheduler, RoundRobinScheduler)
    assert isinstance(models.routing, DirectRouting)
    assert isinstance(models.interference, NoInterference)
    assert isinstance(models.dag_source, SingleDAGSource)
    assert isinstance(models.new_queue(), FifoQueue)
    assert models.new_queue() is not models.new_queue()
    assert str(models.identity("link_model")).startswith("link_model 'static' (ncsim-core ")


def test_the_dag_source_gives_the_scenarios_own_dags(core: Registry):
    loaded = scenario(core)

    injections = assemble(loaded, core).models.dag_source.injections()

    assert tuple(injections) == loaded.injections


@pytest.mark.parametrize(
    ("rates", "message"),
    [
        ("[]", "bandwidth_MBps has 0 values for 1 links"),
        ("[-1]", "bandwidth_MBps of link index 0 is -1"),
    ],
)
def test_wrong_rates_blame_the_link_model(rates, message, with_antenna: Registry):
    config = f"{{link_model: {{type: broken_rates, options: {{rates: {rates}}}}}}}"

    with pytest.raises(PluginError, match=rf"'broken_rates' \(antenna 1.0\): .*{message}"):
        assemble(scenario(with_antenna, config), with_antenna)


@pytest.mark.parametrize(
    "rates",
    [
        None,
        LinkRates((float("nan"),), (0.0,)),
        LinkRates((float("inf"),), (0.0,)),
        LinkRates((1.0,), (-1.0,)),
        LinkRates((1.0,), ()),
    ],
)
def test_rates_that_are_no_numbers_of_zero_or_more_are_refused(rates):
    assert link_rates_fault(rates, 1)


def test_good_rates_have_no_fault():
    assert link_rates_fault(LinkRates((0.0, 2.0), (0.0, 0.1)), 2) is None


@pytest.mark.parametrize("answer", [None, 42, [1.0], LinkRates(None, None), ZeroDivisionError])
def test_what_a_link_model_does_wrong_is_blamed_on_it(answer, monkeypatch):
    def rate_links(self, network):
        if isinstance(answer, type):
            raise answer("oops")
        return answer

    monkeypatch.setattr(StaticLinkModel, "rate_links", rate_links)

    with pytest.raises(PluginError, match="link_model 'static' \\(ncsim-core "):
        assemble(parse_scenario(PLAIN))
