"""Properties of link models."""

import math
from typing import cast

from hypothesis.strategies import SearchStrategy
from typing_extensions import override

from ncsim_core.contracts.link_model import LinkModel
from ncsim_core.network import LinkRates
from ncsim_core.testing import strategies
from ncsim_core.testing.checking import check
from ncsim_core.testing.questions import Case, reversed_links
from ncsim_core.testing.subject import Subject
from ncsim_core.testing.suites.base import ComponentSuite


class LinkModelSuite(ComponentSuite):
    """Checks of a link model."""

    kind = "link_model"

    @override
    def cases(self) -> SearchStrategy[Case]:
        return strategies.questions_about(strategies.networks(is_bandwidth_optional=True))

    @check()
    def check_every_link_is_rated(self, subject: Subject, case: Case) -> None:
        """There is one bandwidth and one latency per link."""
        rates, links = _rates(subject, case), len(case.network.links)
        assert len(rates.bandwidth_MBps) == len(rates.latency_s) == links

    @check()
    def check_rates_are_ordinary_numbers(self, subject: Subject, case: Case) -> None:
        """Bandwidths and latencies are finite and 0 or more."""
        rates = _rates(subject, case)
        for value in (*rates.bandwidth_MBps, *rates.latency_s):
            assert math.isfinite(value), f"{value!r} is not finite"
            assert value >= 0, f"{value!r} is below 0"

    @check()
    def check_listing_order_changes_nothing(self, subject: Subject, case: Case) -> None:
        """Listing the links in another order gives each the same rates."""
        here = _rates(subject, case)
        there = _rates(subject, case.with_network(reversed_links(case.network)))
        assert here == LinkRates(there.bandwidth_MBps[::-1], there.latency_s[::-1])


def _rates(subject: Subject, case: Case) -> LinkRates:
    rates = cast("LinkModel", subject.build(case)).rate_links(case.network)
    assert isinstance(rates, LinkRates), f"rate_links() gave {rates!r}"
    return rates
