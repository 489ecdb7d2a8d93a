"""Compiled loops give the bits that arrays give."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_wifi.phy.mcs import read_table
from ncsim_wifi.spatial import forms
from ncsim_wifi.spatial.plant import Plant
from ncsim_wifi.spatial.scene import scene_of
from ncsim_wifi.spatial.settings import Approximations, Settings, Terms
from ncsim_wifi.spatial.solve import FixedPoint

pytest.importorskip("numba")

links = st.tuples(
    st.tuples(*[st.floats(0, 300)] * 2), st.tuples(*[st.floats(-40, 40)] * 2), st.integers(0, 7)
)


switches = st.builds(
    Terms,
    same_slot_collisions=st.booleans(),
    joint_interference=st.booleans(),
    joint_chains=st.booleans(),
    helpers_by_stage=st.booleans(),
    silence=st.booleans(),
    lost_signal_field=st.booleans(),
)
# few sets: belief propagation; few near ones: others count by groups and as noise
limits = st.builds(Approximations, near_count=st.sampled_from([2, 8]), max_sets=st.just(5))


def plant_of(links, links_per_station, settings):
    """Return links whose senders each have one or several."""
    count = len(links)
    source = np.arange(count) // links_per_station
    senders_m = np.array([at for at, _, _ in links])[source]
    receivers_m = senders_m + np.array([turned for _, turned, _ in links])
    at_m = np.concatenate([np.array([at for at, _, _ in links]), receivers_m])
    apart_m = np.hypot(*(at_m[:, None] - at_m[None]).transpose(2, 0, 1))
    scheme = np.array([scheme for _, _, scheme in links])
    return Plant(
        tuple(f"l{link:02d}" for link in range(count)),
        source,
        np.arange(count) + count,
        scheme,
        np.array(read_table("ax").rate_Mbps)[scheme],
        20.0 - 46.42 - 30.0 * np.log10(np.maximum(apart_m, 1.0)),
        settings,
    )


def assert_same_bits(plant):
    scene = scene_of(plant, range(len(plant.ids)))

    arrays = FixedPoint(scene).goodputs_MBps()
    loops = forms.compiled_loops()(scene).goodputs_MBps()

    assert arrays.tobytes() == loops.tobytes()


@settings(max_examples=60, deadline=None)
@given(st.lists(links, min_size=2, max_size=24), st.integers(1, 3), st.booleans())
def test_goodputs_are_the_same_bits_in_both_forms(links, links_per_station, rts_cts):
    assert_same_bits(plant_of(links, links_per_station, Settings(rts_cts=rts_cts)))


@settings(max_examples=60, deadline=None)
@given(st.lists(links, min_size=2, max_size=16), st.booleans(), switches, limits)
def test_so_they_are_without_some_terms_and_with_other_limits(links, rts_cts, terms, limits):
    settings = Settings(rts_cts=rts_cts, terms=terms, approximations=limits)

    assert_same_bits(plant_of(links, 1, settings))


@settings(max_examples=20, deadline=None)
@given(st.lists(links, min_size=2, max_size=8), st.integers(1, 2), st.data())
def test_steps_are_the_same_bits_when_stations_are_idle_at_times(links, links_per_station, data):
    scene = scene_of(plant_of(links, links_per_station, Settings()), range(len(links)))
    solvers = FixedPoint(scene), forms.compiled_loops()(scene)
    busy = st.floats(1e-3, 1.0)

    for number in range(4):
        one, other = (solver.step(number) for solver in solvers)
        assert one.tobytes() == other.tobytes()
        activity = np.array(data.draw(st.lists(busy, min_size=len(links), max_size=len(links))))
        for solver in solvers:
            solver.load(activity[: scene.station_count], activity)


def test_pure_work_never_imports_numba():
    code = (
        "import sys\n"
        "from ncsim_wifi.spatial.forms import ARRAYS, form_for\n"
        "assert form_for(10**9, 9) is ARRAYS and 'numba' not in sys.modules\n"
    )

    subprocess.run([sys.executable, "-c", code], check=True, env={"NCSIM_PURE": "1"})


def test_numba_is_not_started_for_little_work():
    code = (
        "import sys\n"
        "from ncsim_wifi.spatial.forms import ARRAYS, SAVED_us, form_for\n"
        "assert form_for(1_900_000 // SAVED_us, 1) is ARRAYS\n"
        "assert 'numba' not in sys.modules\n"
        "assert form_for(31_000_000 // SAVED_us, 1) is not ARRAYS\n"
    )

    subprocess.run([sys.executable, "-c", code], check=True, env={})


def test_arrays_are_used_where_numba_cannot_be_imported(tmp_path):
    (tmp_path / "numba.py").write_text("raise ImportError('needs another numpy')\n")
    code = (
        "from ncsim_wifi.spatial.forms import ARRAYS, form_for\n"
        "assert form_for(10**9, 9) is ARRAYS\n"
    )

    subprocess.run([sys.executable, "-c", code], check=True, env={"PYTHONPATH": str(tmp_path)})


def test_loops_give_the_same_bits_when_nothing_is_compiled():
    code = (
        "import numpy as np\n"
        "from test_forms import Settings, assert_same_bits, plant_of\n"
        "at = np.random.default_rng(3).uniform(0.0, 150.0, (6, 2)).tolist()\n"
        "links = [(each, (30.0, 10.0), 5) for each in at]\n"
        "for rts_cts in (False, True):\n"
        "    assert_same_bits(plant_of(links, 1, Settings(rts_cts=rts_cts)))\n"
    )
    env = {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": str(Path(__file__).parent)}

    subprocess.run([sys.executable, "-c", code], check=True, env=env)
