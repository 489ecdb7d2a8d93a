"""The solver: symmetries it must have, and Bianchi on cliques."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_wifi.mac.efficiency import station_goodput_MBps
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.phy.mcs import read_table
from ncsim_wifi.spatial.energy import silenced_by
from ncsim_wifi.spatial.plant import Plant
from ncsim_wifi.spatial.saturated import saturated_goodputs_MBps
from ncsim_wifi.spatial.scene import scene_of
from ncsim_wifi.spatial.settings import Settings, Terms
from ncsim_wifi.spatial.statics import statics_of

SCHEME = 5
RATE_Mbps = read_table("ax").rate_Mbps[SCHEME]


def plant(senders_m, receivers_m, *, rts_cts=False, terms=None):
    count = len(senders_m)
    at_m = np.array([*senders_m, *receivers_m], float)
    apart_m = np.hypot(*(at_m[:, None] - at_m[None]).transpose(2, 0, 1))
    return Plant(
        tuple(f"l{link:02d}" for link in range(count)),
        np.arange(count),
        np.arange(count) + count,
        np.full(count, SCHEME),
        np.full(count, RATE_Mbps),
        20.0 - 46.42 - 30.0 * np.log10(np.maximum(apart_m, 1.0)),
        Settings(rts_cts=rts_cts, terms=terms or Terms()),
    )


def parallel(count, spacing_m, **options):
    rows_m = [spacing_m * row for row in range(count)]
    return plant([(0.0, y) for y in rows_m], [(30.0, y) for y in rows_m], **options)


scenes = st.lists(
    st.tuples(*[st.floats(0, 250)] * 2, *[st.floats(-20, 20)] * 2), min_size=2, max_size=7
)


def scattered(places, *, rts_cts):
    return plant(
        [(x, y) for x, y, _, _ in places],
        [(x + dx + 1, y + dy + 1) for x, y, dx, dy in places],
        rts_cts=rts_cts,
    )


@settings(max_examples=40, deadline=None)
@given(scenes, st.booleans(), st.randoms(use_true_random=False))
def test_goodput_lies_between_zero_and_solo_whatever_the_order(places, rts_cts, random):
    scene = scattered(places, rts_cts=rts_cts)
    order = list(range(len(places)))
    straight = saturated_goodputs_MBps(scene, order)
    random.shuffle(order)

    shuffled = saturated_goodputs_MBps(scene, order)

    assert np.isfinite(straight).all()
    assert (straight >= 0).all()
    assert (straight <= scene.solo_MBps * 1.02).all()
    assert shuffled.tolist() == straight[order].tolist()


@pytest.mark.parametrize("rts_cts", [False, True])
def test_a_link_alone_gets_its_solo_goodput(rts_cts):
    scene = parallel(1, 5.0, rts_cts=rts_cts)

    assert saturated_goodputs_MBps(scene, [0])[0] == pytest.approx(scene.solo_MBps[0])


def test_links_far_apart_do_not_disturb_each_other():
    scene = parallel(2, 2000.0)

    assert saturated_goodputs_MBps(scene, [0, 1]) == pytest.approx(scene.solo_MBps)


@pytest.mark.parametrize("count", [2, 3, 5, 8, 12])
def test_a_clique_shares_like_bianchi(count):
    shares_MBps = saturated_goodputs_MBps(parallel(count, 1.0), range(count))

    bianchi_MBps = station_goodput_MBps(count, RATE_Mbps, AxTiming())
    assert shares_MBps == pytest.approx(np.full(count, bianchi_MBps), rel=0.03)


def test_who_two_harm_only_together_gets_stuck_as_in_packets():
    outer_MBps, inner_MBps = 2.16, 0.55  # ns-3.44: n4_100m of four_five_links.json

    outer, inner = saturated_goodputs_MBps(parallel(4, 100.0), range(4))[:2]
    alike = parallel(4, 100.0, terms=Terms(helpers_by_stage=False))

    assert outer == pytest.approx(outer_MBps, rel=0.02)
    assert inner == pytest.approx(inner_MBps, rel=0.15)
    assert saturated_goodputs_MBps(alike, range(4))[1] < inner


def test_rts_that_collide_with_each_other_harm_no_data():
    senders_m, receivers_m = [(0, 0), (148, 0), (148, 10)], [(30, 0), (163, 0), (163, 10)]

    def partners(*, rts_cts):
        scene = scene_of(plant(senders_m, receivers_m, rts_cts=rts_cts), range(3))
        return statics_of(scene).hostile.has_partners

    assert partners(rts_cts=False)
    assert not partners(rts_cts=True)


def test_data_collide_where_both_rts_are_captured():
    """Seen in frame logs of ns-3.44: both are answered, and both send."""

    def lost(other_receiver_m):
        ends_m = [(10.0, 0.0), other_receiver_m]
        scene = scene_of(plant([(0, 0), (45, 0)], ends_m, rts_cts=True), range(2))
        return statics_of(scene).same_slot_loss[0, 1]

    assert 0.3 < lost((75.0, 0.0)) < 0.6  # data at 16 dB
    assert lost((27.0, 0.0)) == 0.0  # the other RTS is not answered


def test_receivers_that_hear_the_handshake_send_no_acknowledgement_into_the_data():
    senders_m, receivers_m = [(0, 0), (120, 0)], [(20, 0), (70, 0)]

    def harmed(*, rts_cts):
        scene = scene_of(plant(senders_m, receivers_m, rts_cts=rts_cts), range(2))
        return statics_of(scene).acks.link.tolist()

    assert 0 in harmed(rts_cts=False)
    assert 0 not in harmed(rts_cts=True)


def test_an_rts_that_is_captured_does_not_mind_a_later_start():
    def fatal_us(receiver_m):
        scene = scene_of(plant([(0, 0), (95, 0)], [receiver_m, (110, 0)], rts_cts=True), range(2))
        statics = statics_of(scene)
        noticed_us = statics.handshakes.noticed_us.tolist()
        return dict(zip(statics.hostile.link.tolist(), noticed_us, strict=True))

    assert fatal_us((30.0, 0.0))[0] == 0.0
    assert fatal_us((50.0, 0.0))[0] > 0.0


def test_gates_of_a_link_multiply_to_what_sensing_two_together_leaves():
    """Either is too weak for the sender to sense; both together silence it."""
    pair = plant([(0, 0), (80, 0), (-80, 0)], [(0, 30), (110, 0), (-110, 0)])
    statics = statics_of(scene_of(pair, range(3)))
    on = np.full(statics.energy.member.shape, 1e-9)
    row = statics.energy.row_of[0]
    one, two = 0.5, 0.3
    on[row, :2] = one, two

    gates = silenced_by(statics.silencing, on).before[statics.hostile.link == 0]

    met = statics.hostile.station[statics.hostile.link == 0]
    part = np.where(met == statics.energy.member[row, 0], one, two)
    off = (1 - part) / (1 - part + part * gates)
    assert len(gates) == 2
    assert off.prod() == pytest.approx((1 - one) * (1 - two) / (1 - one * two), rel=1e-3)


def test_hidden_pair_gets_what_joint_chains_give_and_not_what_independence_gives():
    with_chains = saturated_goodputs_MBps(parallel(2, 80.0), [0, 1])
    without = saturated_goodputs_MBps(parallel(2, 80.0, terms=Terms(joint_chains=False)), [0, 1])

    assert with_chains == pytest.approx([1.37, 1.37], rel=0.04)
    assert without[0] < 1.1


def test_a_crowd_of_hidden_stations_starves_nobody_altogether():
    """Interferers beyond the nearest are neither constant noise nor always on."""
    rng = np.random.default_rng(30)
    senders_m = rng.uniform(0.0, 250.0, (30, 2))
    turned = rng.uniform(0.0, 2.0 * np.pi, 30)
    receivers_m = senders_m + 30.0 * np.stack([np.cos(turned), np.sin(turned)], axis=1)

    goodputs_MBps = saturated_goodputs_MBps(plant(senders_m, receivers_m), range(30))

    assert goodputs_MBps.min() > 1e-3
    assert goodputs_MBps.sum() < 10.0
