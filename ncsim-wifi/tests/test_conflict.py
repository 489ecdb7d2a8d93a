import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.network import Network, Position
from ncsim_core.testing.builders import line, link, make_context, network_of
from ncsim_wifi import conflict
from ncsim_wifi.conflict import relations
from ncsim_wifi.propagation import propagation
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation import fluid
from ncsim_wifi.validation.scenes import Scene, parallel

PLACES = st.tuples(st.integers(0, 12), st.integers(0, 12)).map(
    lambda at: (25.0 * at[0], 25.0 * at[1])
)
SCENES = st.lists(
    st.tuples(PLACES, PLACES).filter(lambda ends: ends[0] != ends[1]),
    min_size=1,
    max_size=10,
    unique=True,
).flatmap(
    lambda ends: st.booleans().map(
        lambda is_on: Scene(
            tuple(a for a, _ in ends), tuple(b for _, b in ends), (), Radio(rts_cts=is_on)
        )
    )
)


def relations_of(network, **rf):
    return relations(make_context(network), Radio(**rf))


@given(SCENES)
def test_relations_are_those_of_the_definition(scene):
    related = relations_of(scene.network(), rts_cts=scene.radio.rts_cts)
    everyone = frozenset(range(len(scene.senders_m)))

    for victim in everyone:
        neighbours = [other for other in everyone if other != victim
                      and fluid.conflict(victim, other, scene)]  # fmt: skip
        assert related.conflicts(victim).tolist() == neighbours
        hidden_dBm = fluid.hidden_powers_dBm(victim, everyone, scene)
        assert sorted(related.affecting(victim).tolist()) == sorted([*neighbours, *hidden_dBm])
        for other, power_dBm in hidden_dBm.items():
            victims, powers_mW = related.hidden(other)
            at = victims.tolist().index(victim)
            assert 10 * math.log10(powers_mW[at]) == pytest.approx(power_dBm)


def test_links_at_one_receiver_conflict_even_when_nobody_hears_anybody():
    network = network_of([Position(0, 0), Position(100, 0), Position(200, 0)], ())
    shared = Network(network.nodes, (link(0, 1), link(2, 1)))

    assert relations_of(shared).conflicts(0).tolist() == [1]


@pytest.mark.parametrize("ends", [((0, 1), (0, 2)), ((0, 1), (1, 2)), ((0, 1), (2, 1))])
@pytest.mark.parametrize("rts_cts", [False, True])
def test_links_that_share_a_node_conflict_even_if_nothing_is_ever_sensed(ends, rts_cts):
    places = [Position(0, 0), Position(10, 0), Position(20, 0)]
    network = network_of(places, ())
    shared = Network(network.nodes, tuple(link(*each) for each in ends))

    related = relations_of(shared, rts_cts=rts_cts, cca_threshold_dBm=100.0)

    assert [related.conflicts(i).tolist() for i in (0, 1)] == [[1], [0]]


def test_rts_cts_adds_what_receivers_hear():
    facing = Scene(((0.0, 0.0), (160.0, 0.0)), ((50.0, 0.0), (110.0, 0.0)), ()).network()

    assert relations_of(facing).conflicts(0).tolist() == []
    assert relations_of(facing, rts_cts=True).conflicts(0).tolist() == [1]


def test_interferers_below_the_cutoff_are_left_out():
    network = parallel(2, 450.0).network()

    assert relations_of(network).affected(0).tolist() == []
    assert relations_of(network, interference_cutoff_dBm=-120.0).affected(0).tolist() == [1]


def test_an_interferer_exactly_at_the_cutoff_counts():
    network = parallel(2, 450.0).network()
    power_dBm = propagation(make_context(network), Radio()).power_dBm
    at_receiver_dBm = float(power_dBm[network.sources[0], network.targets[1]])
    just_above_dBm = float(np.nextafter(at_receiver_dBm, 0.0))

    assert relations_of(network, interference_cutoff_dBm=at_receiver_dBm).affected(0).tolist() == [
        1
    ]
    assert relations_of(network, interference_cutoff_dBm=just_above_dBm).affected(0).tolist() == []


def test_wired_links_are_related_to_nobody():
    network = parallel(3, 5.0).network()
    wired = tuple(
        each if i != 1 else type(each)(each.id, each.source, each.target, 5.0, 0.0, "wired")
        for i, each in enumerate(network.links)
    )

    related = relations_of(Network(network.nodes, wired))

    assert [related.affected(i).tolist() for i in range(3)] == [[2], [], [0]]


def test_blocks_of_any_size_give_the_same(monkeypatch):
    network = line(9, bandwidth_MBps=None)
    whole = relations_of(network)
    monkeypatch.setattr(conflict, "CELLS_PER_BLOCK", 20)

    parts = relations_of(network)

    for name in ("starts", "links", "is_conflict", "hidden_starts", "hidden_mW"):
        assert np.array_equal(getattr(whole, name), getattr(parts, name)), name


def test_a_network_without_links_has_empty_relations():
    related = relations_of(Network((), ()))

    assert related.link_count == 0
    assert related.conflict_counts.tolist() == []


def test_relations_are_worked_out_once_per_network_and_radio():
    context = make_context(parallel(2, 40.0).network())

    assert relations(context, Radio()) is relations(context, Radio())
    assert relations(context, Radio()) is not relations(context, Radio(rts_cts=True))


def test_reach_holds_the_changed_links_and_all_they_affect():
    related = relations_of(parallel(4, 60.0).network())

    assert related.reach([0]) == {0, *related.affected(0).tolist()}
