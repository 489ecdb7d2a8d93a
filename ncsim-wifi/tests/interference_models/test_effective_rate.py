"""The default model and its incremental forms, against the paper's formulas taken literally."""

import gc
import pickle
import random
import weakref
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_core.context import ModelCache
from ncsim_core.contracts.interference_model import PlainSession
from ncsim_core.engine.sessions import array_session, loads, tabled_session
from ncsim_core.engine.sessions.array_session import ArraySession
from ncsim_core.engine.sessions.choice import loads_of, session_for
from ncsim_core.engine.sessions.row_session import RowSession
from ncsim_core.generators.paper import paper_grid, parallel_links
from ncsim_core.testing.builders import make_context
from ncsim_wifi.interference_models.csma_bianchi import csma_bianchi
from ncsim_wifi.validation import fluid
from ncsim_wifi.validation.scenes import Scene

PLACES = st.tuples(st.integers(0, 40), st.integers(0, 40)).map(
    lambda at: (7.3 * at[0], 8.1 * at[1])
)
ENDS = st.tuples(PLACES, PLACES).filter(lambda ends: ends[0] != ends[1])
SCENES = st.lists(ENDS, min_size=1, max_size=14, unique=True).map(
    lambda ends: Scene(tuple(a for a, _ in ends), tuple(b for _, b in ends), ())
)
TOGGLES = st.lists(st.lists(st.integers(0, 13), min_size=1, max_size=4, unique=True), max_size=25)


def model_of(network, rf=None, **options):
    context = replace(make_context(network, sections={"rf": rf or {}}), cache=ModelCache())
    return csma_bianchi(context, **options)


@given(SCENES, st.sets(st.integers(0, 13)))
def test_factors_are_those_of_the_formulas_taken_literally(scene, chosen):
    usable = [i for i in range(len(scene.senders_m)) if fluid.clean_rate_Mbps(i, scene) > 0]
    active = [i for i in usable if i in chosen]

    factors = model_of(scene.network()).factors(active, active)

    expected = [fluid.effective_rate_factor(i, frozenset(active), scene) for i in active]
    assert factors.tolist() == pytest.approx(expected, rel=1e-12)


SESSIONS = {"rows": RowSession, "matrix": ArraySession, "lists": ArraySession}


def session_on(model, form="rows"):
    return SESSIONS[form](loads_of(model.tables()))


class TestSessions:
    @pytest.fixture(params=SESSIONS)
    def form(self, request, monkeypatch):
        if request.param == "lists":
            monkeypatch.setattr(array_session, "MAX_LINKS_OF_MATRIX", 0)
        return request.param

    @pytest.mark.parametrize("options", [{}, {"outage_floor_factor": 0.02}])
    @pytest.mark.parametrize("rf", [{}, {"rts_cts": True}, {"tx_power_dBm": 12.0}])
    def test_long_random_histories_stay_exact(self, form, options, rf):
        network = paper_grid(6)
        model = model_of(network, rf, **options)
        draw = random.Random(5)
        history = [draw.sample(range(len(network.links)), draw.randint(1, 9)) for _ in range(60)]

        follow(model, history, form)

    def test_hundreds_of_links_at_one_place_are_counted_right(self, form):
        network = parallel_links(260, 0.25)

        follow(model_of(network), [list(range(260)), [3, 4, 5], [3, 9]], form)


def test_tables_too_large_for_sums_of_64_bits_fall_back_to_the_plain_form(monkeypatch):
    model = model_of(paper_grid(3))
    monkeypatch.setattr(loads, "LOAD_BITS", 40)

    assert type(session_for(model, model.tables())) is PlainSession


@settings(max_examples=60)
@given(SCENES, TOGGLES, st.sampled_from(["rows", "matrix"]))
def test_sessions_equal_global_refresh_bit_by_bit(scene, toggles, form):
    count = len(scene.senders_m)
    model = model_of(scene.network())
    history = [[link for link in step if link < count] for step in toggles]

    follow(model, history, form)


def follow(model, history, form):
    """Toggle links; after each step factors must equal those of asking for all links anew."""
    session, factors = session_on(model, form), {}
    for step in history:
        off = [link for link in step if link in factors]
        on = [link for link in step if link not in factors]
        for link in off:
            del factors[link]
        factors.update(dict.fromkeys(on, 1.0))
        links, changed = session.update(on, off)
        factors.update(zip(links, changed, strict=True))
        active = sorted(factors)
        assert [factors[link] for link in active] == model.factors(active, active).tolist()
    active = sorted(factors)
    assert list(session.competition(active)) == list(model.competition(active, active))


@pytest.mark.parametrize("form", SESSIONS)
def test_switching_on_and_off_again_leaves_no_trace(form):
    model = model_of(paper_grid(4))
    session = session_on(model, form)
    session.update([0, 1, 2], [])
    before = list(session.competition([0, 1, 2]))

    session.update(list(range(10, 60)), [])
    changed, factors = session.update([], list(range(10, 60)))

    assert list(session.competition([0, 1, 2])) == before
    assert set(changed) <= {0, 1, 2}
    after = dict(zip(changed, factors, strict=True))
    expected = model.factors([0, 1, 2], [0, 1, 2]).tolist()
    assert all(factor == expected[link] for link, factor in after.items())


def test_a_model_survives_pickling_with_its_caches_warm():
    model = model_of(paper_grid(3))
    session_on(model).update([0, 1], [])

    copy = pickle.loads(pickle.dumps(model))

    assert copy.factors([0, 1], [0, 1]).tolist() == model.factors([0, 1], [0, 1]).tolist()


def test_competition_is_right_after_any_number_of_switches_that_nobody_asked_about(monkeypatch):
    monkeypatch.setattr(tabled_session, "MAX_TOGGLED", 5)
    draw = random.Random(7)

    follow(model_of(paper_grid(3)), [draw.sample(range(24), 4) for _ in range(30)], "rows")


def test_what_sessions_keep_goes_with_the_model():
    model = model_of(paper_grid(3))
    for form in SESSIONS:
        session_on(model, form).update([0, 1], [])
    kept = [weakref.ref(loads_of(model.tables())), weakref.ref(model.tables())]

    del model
    gc.collect()

    assert [each() for each in kept] == [None, None]
