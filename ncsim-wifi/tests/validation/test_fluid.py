import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation import fluid, internal
from ncsim_wifi.validation.engine_runs import FIXED_CAPTURE, measure
from ncsim_wifi.validation.scenes import Flow, Scene, parallel, single


def test_a_lone_flow_takes_size_over_goodput():
    scene = single(30.0)

    assert fluid.ends_s(scene) == pytest.approx([1000.0 / fluid.clean_goodput_MBps(0, scene)])


def test_a_flow_that_gets_nothing_never_ends():
    assert fluid.ends_s(single(140.0)) == [math.inf]


def test_a_late_flow_changes_rates_when_it_starts():
    scene = parallel(2, 20.0, [Flow(0, 10.0), Flow(1, 10.0, 1.0)])
    alone_MBps, shared_MBps = fluid.rates_MBps([0], scene)[0], fluid.rates_MBps([0, 1], scene)[0]

    assert fluid.ends_s(scene)[0] == pytest.approx(1.0 + (10.0 - alone_MBps) / shared_MBps)


def test_the_rate_log_averages_over_windows():
    rates = measure(parallel(2, 20.0, [Flow(0, 10.0), Flow(1, 1.0, 1.0)])).rates

    assert rates.mean_rate_MBps(1, 0.0, 1.0) == 0.0
    assert rates.mean_rate_MBps(0, 0.0, 1.0) == pytest.approx(3.783, abs=5e-4)
    assert rates.mean_rate_MBps(0, 0.5, 1.25) == pytest.approx(
        (0.5 * 3.78309 + 0.25 * 1.94249) / 0.75, abs=1e-4
    )


@pytest.mark.parametrize("separation_m", [20.0, 70.0, 72.0, 100.0, 120.0])
def test_the_engine_follows_the_fluid_in_fixed_capture_too(separation_m):
    scene = parallel(2, separation_m, [Flow(0, 10.0), Flow(1, 5.0, 0.5)])
    measured = measure(scene, FIXED_CAPTURE)

    expected_s = fluid.ends_s(scene, fluid.fixed_capture_factor)

    assert [measured.end_s(0), measured.end_s(1)] == pytest.approx(expected_s, abs=4e-6)


def test_links_of_the_cascade_pause_and_resume():
    scene = internal.OTHER_EXPERIMENTS["8 hidden cascade"]["5 links of 100 m, 75 m: pauses"]

    at_first = fluid.rates_MBps(range(5), scene)

    assert [at_first[flow] == 0.0 for flow in range(5)] == [False, True, True, True, False]
    assert max(fluid.ends_s(scene)) < math.inf


PLACES = st.tuples(st.integers(0, 30), st.integers(0, 30)).map(
    lambda at: (7.3 * at[0], 8.1 * at[1])
)
LINKS = st.lists(
    st.tuples(PLACES, PLACES).filter(lambda ends: 0.0 < math.dist(*ends) < 120.0),
    min_size=1,
    max_size=6,
    unique=True,
)
FLOWS = st.builds(
    Flow,
    st.integers(0, 5),
    st.sampled_from([0.5, 2.0, 5.0]),
    st.sampled_from([0.0, 0.0, 0.1, 0.7, 1.3]),
)
RADIOS = st.builds(Radio, rts_cts=st.booleans(), capture_margin_dB=st.sampled_from([0.0, 5.0, 8.0]))


@settings(max_examples=40)
@given(LINKS, st.lists(FLOWS, min_size=1, max_size=8), RADIOS)
def test_the_engine_follows_the_fluid_in_any_scene(ends, flows, radio):
    on_links = tuple(replace(flow, link=flow.link % len(ends)) for flow in flows)
    scene = Scene(tuple(a for a, _ in ends), tuple(b for _, b in ends), on_links, radio)
    measured = measure(scene)

    ends_s = [measured.end_s(flow) for flow in range(len(flows))]

    assert ends_s == pytest.approx(fluid.ends_s(scene), abs=2e-5)
