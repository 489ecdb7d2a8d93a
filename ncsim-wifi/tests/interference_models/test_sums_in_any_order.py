"""Factors do not depend on the order or the history in which interferers came, to the last bit.

The powers at the receivers lie up to twelve orders of magnitude apart, where sums of floats would
depend on their order: adding and removing a strong one would leave nothing of the weak.
"""

import math
import random
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_core.context import ModelCache
from ncsim_core.contracts.interference_model import PlainSession
from ncsim_core.engine.sessions.choice import sessions_on
from ncsim_core.generators.paper import parallel_links
from ncsim_core.network import Link, Network, Node, Position
from ncsim_core.testing.builders import make_context, rated
from ncsim_wifi.interference_models.csma_bianchi import csma_bianchi
from ncsim_wifi.interference_models.csma_clique import CsmaCliqueModel
from ncsim_wifi.interference_models.csma_spatial import csma_spatial
from ncsim_wifi.interference_models.proximity import ProximityModel

DEAF = {"cca_threshold_dBm": 30.0, "interference_cutoff_dBm": -300.0, "noise_floor_dBm": -145.0}
"""Nobody hears anybody, and everything counts: the sums hold all powers."""
RADIOS = {"deaf": DEAF, "usual": {}}
MODELS = {
    "effective_rate": csma_bianchi,
    "clique": CsmaCliqueModel,
    "spatial": csma_spatial,
    "proximity": ProximityModel,
}
EXPONENTS = st.floats(-0.5, 3.5)
"""Of distances in m: with path loss exponent 3, powers over twelve orders of magnitude."""
LENGTH_m = 900.0


def network_of(exponents, order):
    """Return a long link and around its receiver, 10 ** exponent m away, the sender of each other.

    Args:
        exponents: One for each link but the first.
        order: Of the links, by number.
    """
    nodes = {0: (Position(0.0, -LENGTH_m), Position(0.0, 0.0))}
    for number, exponent in enumerate(exponents, 1):
        east, north = math.cos(number), math.sin(number)
        far_m, farther_m = 10.0**exponent, 10.0**exponent + 1.0
        sender, receiver = (Position(each * east, each * north) for each in (far_m, farther_m))
        nodes[number] = (sender, receiver)
    ends = [(f"{end}{n}", at) for n in order for end, at in zip("ab", nodes[n], strict=True)]
    links = [Link(f"l{n}", f"a{n}", f"b{n}", 10.0) for n in order]
    return rated(Network(tuple(Node(name, 1.0, at) for name, at in ends), tuple(links)))


def model_of(kind, network, rf=DEAF):
    return MODELS[kind](replace(make_context(network, sections={"rf": rf}), cache=ModelCache()))


def direct(model, active):
    """Return the factor of each active link, as bits, by name of its number."""
    factors = model.factors(active, active).tolist()
    return {link: factor.hex() for link, factor in zip(active, factors, strict=True)}


def after(session, steps):
    """Return the factors that a session has told after links went on and off."""
    factors = {}
    for on, off in steps:
        links, told = session.update(on, off)
        for link in off:
            del factors[link]
        factors |= dict.fromkeys(on, 1.0)
        factors |= dict(zip(links, told, strict=True))
    return {link: float(factor).hex() for link, factor in factors.items()}


def history(active, others, chance):
    """Return steps at whose end the links of ``active`` are on: with detours over all others."""
    steps, on = [], []
    for link in chance.sample(active, len(active)):
        guests = chance.sample(others, min(len(others), chance.randint(0, 3)))
        leaving = chance.sample(on, min(len(on), chance.randint(0, 2)))
        steps += [(guests, leaving), ([link, *leaving], guests)]
        on.append(link)
    return steps


def sessions_of(model):
    tables = model.tables()
    return [PlainSession(model), model.open_session(), *(sessions_on(tables) if tables else [])]


@pytest.mark.parametrize("rf", RADIOS)
@pytest.mark.parametrize("kind", MODELS)
@settings(max_examples=8, deadline=None)
@given(st.lists(EXPONENTS, min_size=1, max_size=9), st.randoms(use_true_random=False))
def test_any_order_and_any_history_give_the_same_bits(kind, rf, exponents, chance):
    count = len(exponents) + 1
    network = network_of(exponents, range(count))
    active = sorted(chance.sample(range(count), chance.randint(1, count)))
    others = [link for link in range(count) if link not in active]
    expected = direct(model_of(kind, network, RADIOS[rf]), active)

    model = model_of(kind, network, RADIOS[rf])
    for session in sessions_of(model):
        assert after(session, history(active, others, chance)) == expected
    assert (
        direct(model_of(kind, network, RADIOS[rf]), chance.sample(active, len(active))) == expected
    )


@pytest.mark.parametrize("rf", RADIOS)
@pytest.mark.parametrize("kind", MODELS)
@settings(max_examples=8, deadline=None)
@given(st.lists(EXPONENTS, min_size=1, max_size=9), st.randoms(use_true_random=False))
def test_the_order_of_links_in_the_file_changes_no_bit(kind, rf, exponents, chance):
    order = list(range(len(exponents) + 1))
    expected = direct(model_of(kind, network_of(exponents, order), RADIOS[rf]), order)
    chance.shuffle(order)

    found = direct(model_of(kind, network_of(exponents, order), RADIOS[rf]), range(len(order)))
    assert {order[place]: factor for place, factor in found.items()} == expected


def test_a_strong_interferer_that_comes_and_goes_takes_nothing_of_the_weak_along():
    exponents = [-0.5, *(3.5 - 0.01 * number for number in range(8))]
    model = model_of("effective_rate", network_of(exponents, range(10)))
    weak = [0, *range(2, 10)]
    expected = direct(model, weak)

    assert expected[0] != direct(model, [0])[0]  # the weak ones are felt
    for session in sessions_of(model):
        steps = [(weak, []), *([([1], []), ([], [1])] * 50)]
        assert after(session, steps) == expected


@pytest.mark.parametrize("rf", RADIOS)
def test_a_thousand_links_in_any_order_give_the_same_bits(rf):
    network = parallel_links(1000, 0.07)
    model = model_of("effective_rate", network, RADIOS[rf])
    links = list(range(1000))
    expected = direct(model, links)

    chance = random.Random(7)
    for session in sessions_on(model.tables()):
        shuffled = chance.sample(links, 1000)
        steps = [(shuffled[:500], []), (shuffled[500:], shuffled[:90]), (shuffled[:90], [])]
        assert after(session, steps) == expected
