"""Properties of interference models that give whole routes their rates."""

import math
from collections.abc import Sequence
from typing import cast

from hypothesis import assume

from ncsim_core.contracts.interference_model import InterferenceModel
from ncsim_core.engine.boundary import route_rates_fault
from ncsim_core.engine.setup import Reach
from ncsim_core.network import LinkIndex, Route
from ncsim_core.testing.checking import check
from ncsim_core.testing.questions import Case, route_answers
from ncsim_core.testing.runs import run_with
from ncsim_core.testing.subject import Subject

ROUNDING = 1e-9
"""Part of a rate that may depend on the order of routes."""


class RouteRateChecks:
    """Checks of ``route_rates``, for models that decide routes and say so."""

    @check()
    def check_deciding_routes_is_declared(self, subject: Subject, relayed: Case) -> None:
        """A model that decides routes has the capability ``decides_routes``."""
        model = cast("InterferenceModel", subject.build(relayed))
        is_declared = subject.capability("decides_routes") is not None
        assert is_declared or not model.decides_routes, "it decides routes without saying so"

    @check(capability="decides_routes")
    def check_route_rates_fit_their_links(self, subject: Subject, relayed: Case) -> None:
        """Rates are ordinary numbers, bottlenecks on their routes, and links not overloaded."""
        model, routes = _asked_about(subject, relayed)
        answers = route_answers(model, routes)
        rates_MBps, bottlenecks = zip(*answers, strict=True)
        fault = route_rates_fault(routes, rates_MBps, bottlenecks, relayed.network)
        assert fault is None, f"it {fault}"

    @check(capability="decides_routes")
    def check_alone_a_route_keeps_its_bandwidth(self, subject: Subject, relayed: Case) -> None:
        """Alone, one link gets its clean bandwidth; relaying may cost something, but not all."""
        model, routes = _asked_about(subject, relayed)
        for route in routes:
            ((rate_MBps, _),) = route_answers(model, [route])
            clean_MBps = relayed.network.route_bottleneck_MBps(route)
            assert 0.0 < rate_MBps <= clean_MBps * (1 + ROUNDING), f"{route}: {rate_MBps} MB/s"
            if len(route) == 1:
                assert _is_close(rate_MBps, clean_MBps), f"{rate_MBps} of {clean_MBps} MB/s"

    @check(capability="decides_routes")
    def check_order_of_routes_changes_nothing(self, subject: Subject, relayed: Case) -> None:
        """Rates depend on the routes in use, not on how they are listed."""
        model, routes = _asked_about(subject, relayed)
        rates_MBps = _rates(route_answers(model, routes))
        backwards_MBps = _rates(route_answers(model, routes[::-1]))[::-1]
        assert all(map(_is_close, rates_MBps, backwards_MBps)), f"{rates_MBps}, {backwards_MBps}"

    @check(capability="decides_routes")
    def check_route_rates_have_no_memory(self, subject: Subject, relayed: Case) -> None:
        """What was asked before changes no answer, to the last bit."""
        model, routes = _asked_about(subject, relayed)
        for count in (*range(1, len(routes)), *range(len(routes), 0, -1)):
            fresh = cast("InterferenceModel", subject.build(relayed))
            expected = route_answers(fresh, routes[:count])
            assert route_answers(model, routes[:count]) == expected, f"routes {routes[:count]}"

    @check(capability="decides_routes")
    def check_moving_few_routes_equals_moving_all(
        self, subject: Subject, relayed_run: Case
    ) -> None:
        """A run that touches only transfers whose rate moves goes like one that touches all."""
        local, slow = (run_with(subject, relayed_run, reach, "coarse") for reach in Reach)
        assert local == slow


def _asked_about(subject: Subject, case: Case) -> tuple[InterferenceModel, Sequence[Route]]:
    """Return the model and usable routes, leaving out what it does not decide."""
    model = cast("InterferenceModel", subject.build(case))
    assume(model.decides_routes and case.usable_routes)
    return model, case.usable_routes


def _rates(answers: Sequence[tuple[float, LinkIndex]]) -> list[float]:
    return [rate_MBps for rate_MBps, _ in answers]


def _is_close(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=ROUNDING, abs_tol=ROUNDING)
