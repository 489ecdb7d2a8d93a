"""Properties of interference models; the engine's local refresh stands on several of them."""

from collections.abc import Iterator, Mapping, Sequence
from typing import cast

import numpy as np
from hypothesis.strategies import SearchStrategy
from typing_extensions import override

from ncsim_core.contracts.interference_model import (
    InterferenceModel,
    InterferenceSession,
    PlainSession,
)
from ncsim_core.engine.sessions.choice import sessions_on
from ncsim_core.engine.setup import Reach
from ncsim_core.network import LinkIndex
from ncsim_core.testing import strategies
from ncsim_core.testing.checking import check
from ncsim_core.testing.questions import Case
from ncsim_core.testing.runs import run_with
from ncsim_core.testing.subject import Subject
from ncsim_core.testing.suites.base import ComponentSuite
from ncsim_core.testing.suites.route_rates import RouteRateChecks


class InterferenceModelSuite(RouteRateChecks, ComponentSuite):
    """Checks of an interference model. Equal means equal: to the last bit."""

    kind = "interference_model"

    @override
    def cases(self) -> SearchStrategy[Case]:
        return strategies.traffic()

    @override
    def strategies(self) -> Mapping[str, SearchStrategy[object]]:
        return {
            **super().strategies(),
            "run": strategies.busy_runs(),
            "relayed": strategies.relayed_traffic(),
            "relayed_run": strategies.relayed_runs(),
        }

    @check()
    def check_factors_are_shares(self, subject: Subject, case: Case) -> None:
        """There is one factor per link asked for, in [0, 1]."""
        factors: object = _model(subject, case).factors(case.active, case.active)
        assert isinstance(factors, np.ndarray), f"factors() gave {factors!r}, not an array of numpy"
        count = len(case.active)
        assert factors.shape == (count,), f"shape {factors.shape}; {count} links were asked about"
        for link, factor in zip(case.active, factors.tolist(), strict=True):
            is_share = isinstance(factor, int | float) and 0.0 <= factor <= 1.0  # nan is none
            assert is_share, f"link {link} has factor {factor!r}, not a number from 0 to 1"

    @check()
    def check_alone_a_link_keeps_its_bandwidth(self, subject: Subject, case: Case) -> None:
        """The factor of a link that is alone is 1."""
        model = _model(subject, case)
        for link in range(len(case.network.links)):
            factors = _factors(model, [link], [link])
            assert factors == [1.0], f"alone, link {link} has factor {factors}, not 1"

    @check()
    def check_order_of_links_changes_nothing(self, subject: Subject, case: Case) -> None:
        """Factors depend on the set of active links, not on how it is listed."""
        model = _model(subject, case)
        backwards = case.active[::-1]
        expected = _factors(model, case.active, case.active)
        for links, active, wanted in (
            (case.active, backwards, expected),
            (backwards, set(case.active), expected[::-1]),
        ):
            got = _factors(model, links, active)
            assert got == wanted, f"{got} instead of {wanted} with active links as {active}"

    @check()
    def check_asking_for_fewer_changes_nothing(self, subject: Subject, case: Case) -> None:
        """A link has the same factor whether asked for alone or with others."""
        model = _model(subject, case)
        together = _factors(model, case.active, case.active)
        apart = [_factors(model, [link], case.active)[0] for link in case.active]
        assert apart == together, f"asked about one by one {apart}, about all {together}"

    @check()
    def check_reach_holds_what_changed(self, subject: Subject, case: Case) -> None:
        """The links that change are in reach of themselves."""
        reach = set(_model(subject, case).reach(case.active))
        assert reach >= set(case.active), f"reach({case.active}) is {sorted(reach)}"
        assert reach <= set(range(len(case.network.links))), f"no such links: {sorted(reach)}"

    @check()
    def check_out_of_reach_nothing_changes(self, subject: Subject, case: Case) -> None:
        """Switching a link moves no factor outside its reach."""
        model = _model(subject, case)
        for switched in range(len(case.network.links)):
            rest = [link for link in case.active if link != switched]
            far = [link for link in rest if link not in set(model.reach([switched]))]
            without = _factors(model, far, rest)
            with_it = _factors(model, far, [*rest, switched])
            assert with_it == without, (
                f"reach([{switched}]) leaves out some of {far}, whose factors go from "
                f"{without} to {with_it} when link {switched} is switched on"
            )

    @check()
    def check_session_equals_global_refresh(self, subject: Subject, case: Case) -> None:
        """A session gives what asking for every active link after every change gives."""
        model = _model(subject, case)
        _follow(model.open_session(), model, case)

    @check()
    def check_tables_equal_plain_form(self, subject: Subject, case: Case) -> None:
        """If it has tables, each way to work on them gives what the plain form gives."""
        model = _model(subject, case)
        tables = model.tables()
        if tables is None:
            return
        fault = tables.fault(len(case.network.links))
        assert fault is None, f"its tables have {fault}"
        assert model.tables() is tables, "tables() makes new tables each time"
        for session in sessions_on(tables):
            _follow(session, model, case)

    @check()
    def check_local_refresh_equals_global(self, subject: Subject, run: Case) -> None:
        """A run that asks only about links in reach goes like one that asks about all.

        To the microsecond; which rates are looked at again differs, so those are left out.
        """
        local, slow = (run_with(subject, run, reach, "coarse") for reach in Reach)
        assert local == slow, (
            "asking only about links in reach() gives another run: it is too small"
        )

    @check()
    def check_sessions_do_not_meet(self, subject: Subject, case: Case) -> None:
        """Two sessions of one model know nothing of each other."""
        model = _model(subject, case)
        first, second = _Followed(model.open_session()), _Followed(model.open_session())
        alone = _Followed(model.open_session())
        steps = list(_switches(case))
        ends = [alone.update(on, off) for on, off in steps]
        met = "a session's answers depend on another session of the same model"
        assert [first.update(*steps[0]) for _ in steps[:1]] == ends[:1], met
        assert [second.update(on, off) for on, off in steps] == ends, met
        assert [first.update(on, off) for on, off in steps[1:]] == ends[1:], met

    @check()
    def check_competition_can_be_explained(self, subject: Subject, case: Case) -> None:
        """Each link has counts of 0 or more and a hidden factor in [0, 1]."""
        told = _model(subject, case).competition(case.active, case.active)
        count = len(case.active)
        assert len(told) == count, f"competition() gave {len(told)} answers for {count} links"
        for each in told:
            assert each.contenders >= 0, each
            assert each.hidden_interferers >= 0, each
            assert 0.0 <= each.hidden_factor <= 1.0, each

    @check(capability="monotone")
    def check_one_more_link_never_helps(self, subject: Subject, case: Case) -> None:
        """Switching one more link on raises no factor."""
        model = _model(subject, case)
        before = _factors(model, case.active, case.active)
        for extra in set(range(len(case.network.links))) - set(case.active):
            after = _factors(model, case.active, [*case.active, extra])
            better = [
                k for k, pair in enumerate(zip(before, after, strict=True)) if pair[1] > pair[0]
            ]
            assert not better, f"link {extra} raises the factors of {better}"


def _follow(session: InterferenceSession, model: InterferenceModel, case: Case) -> None:
    """Check that a session gives what asking for every active link gives, step by step."""
    fast, slow = _Followed(session), _Followed(PlainSession(model, is_global=True))
    for on, off in _switches(case):
        expected = slow.update(on, off)
        got = fast.update(on, off)
        assert got == expected, (
            f"{type(session).__name__}: {got} instead of {expected} after {on} on, {off} off"
        )
        links = sorted(expected)
        told = list(session.competition(links))
        assert told == list(model.competition(links, links)), f"competition of {links}"


class _Followed:
    """A session and the factors that follow from what it said."""

    def __init__(self, session: InterferenceSession) -> None:
        self.session = session
        self._factors: dict[LinkIndex, float] = {}

    def update(self, on: Sequence[LinkIndex], off: Sequence[LinkIndex]) -> dict[LinkIndex, float]:
        """Return all factors after a change."""
        for link in off:
            del self._factors[link]
        self._factors.update(dict.fromkeys(on, 1.0))
        links, factors = self.session.update(on, off)
        assert set(links) <= self._factors.keys(), f"{links} are not all active"
        self._factors.update(zip(links, map(float, factors), strict=True))
        return dict(self._factors)


def _switches(case: Case) -> Iterator[tuple[list[LinkIndex], list[LinkIndex]]]:
    """Yield what to switch on and off, step by step: first all active links, then each toggle.

    Every third toggle goes together with the one before it, as transfers of several links do.
    """
    active = set(case.active)
    yield list(case.active), []
    waiting: list[LinkIndex] = []
    for number, link in enumerate(case.toggles):
        waiting = [*waiting, link] if link not in waiting else waiting
        if number % 3 != 1:
            on = [each for each in waiting if each not in active]
            off = [each for each in waiting if each in active]
            active = (active | set(on)) - set(off)
            waiting = []
            yield on, off


def _model(subject: Subject, case: Case) -> InterferenceModel:
    return cast("InterferenceModel", subject.build(case))


def _factors(
    model: InterferenceModel,
    links: Sequence[LinkIndex],
    active: Sequence[LinkIndex] | set[LinkIndex],
) -> list[float]:
    """Return factors as numbers; nobody is asked about no links."""
    return [float(each) for each in model.factors(links, active)] if links else []
