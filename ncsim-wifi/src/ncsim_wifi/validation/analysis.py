"""Stage 1 without the engine: constants, the solver, isolated links, feasibility of shares."""

import random
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import permutations

from ncsim_core.context import BuildContext, ModelCache
from ncsim_core.network import Network

from ncsim_wifi.conflict import relations
from ncsim_wifi.interference_models.csma_bianchi import csma_bianchi
from ncsim_wifi.link_models.wifi import WifiLinkModel
from ncsim_wifi.mac.bianchi import (
    MAX_BACKOFF_STAGE,
    MAX_RESIDUAL,
    MIN_CONTENTION_WINDOW,
    fixed_point,
    residual,
)
from ncsim_wifi.mac.efficiency import efficiency, station_goodput_MBps
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.phy.mcs import rate_table
from ncsim_wifi.phy.path_loss import reference_loss_dB
from ncsim_wifi.phy.sensing import carrier_sensing_range_m
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation.decimal_solver import decimal_tau
from ncsim_wifi.validation.rows import Row, half_a_digit
from ncsim_wifi.validation.scenes import Scene, single

compared = partial(Row, "internal")

MARGINS_dB = (0.0, 3.0, 5.0, 8.0)
STATIONS_OF_SECOND_SOLVER = (8, 20, 50, 100, 101, 256, 1000)
MAX_STATIONS = 1000
MAX_RELATIVE_TAU_ERROR = 1e-12
STEP_ASIDE = 1e-6  # relative distance from a threshold, on either side
SCENES, LINKS_PER_SCENE, FIELD_m = 40, 12, 220.0


def constants() -> Iterator[Row]:
    """Yield the numbers that are known to many digits."""
    range_m = carrier_sensing_range_m(Radio())
    head = "constants"
    yield compared(head, "carrier sensing", "range m", 71.2242, "by hand", range_m, half_a_digit(4))
    for n, rate_Mbps, expected, digits in (
        (1, 8.6, 0.834788, 6),
        (1, 143.4, 0.279415, 6),
        (100, 68.8, 0.282560850, 9),
    ):
        eta = efficiency(n, rate_Mbps, AxTiming())
        case = f"n = {n}, {rate_Mbps} Mb/s"
        yield compared(head, case, "eta", expected, "paper", eta, half_a_digit(digits))


def solver() -> Iterator[Row]:
    """Yield residuals for n = 1..1000, and a second solver with 60 decimal digits."""
    window, stage = MIN_CONTENTION_WINDOW, MAX_BACKOFF_STAGE
    worst = max(
        abs(residual(fixed_point(n).p, n, window, stage)) for n in range(1, MAX_STATIONS + 1)
    )
    head = "Bianchi solver"
    case = f"n = 1..{MAX_STATIONS}"
    yield compared(head, case, "residual", MAX_RESIDUAL, "paper", worst, 0.0, "<=")
    for n in STATIONS_OF_SECOND_SOLVER:
        expected = float(decimal_tau(n))
        tolerance = MAX_RELATIVE_TAU_ERROR * expected
        tau = fixed_point(n).tau
        yield compared(head, f"n = {n}", "tau", expected, "60 digits", tau, tolerance)


def threshold_distances_m(radio: Radio) -> list[float]:
    """Return the length of a link at each threshold of its rate table."""
    spare_dB = radio.tx_power_dBm - reference_loss_dB(radio.freq_ghz) - radio.noise_floor_dBm
    return [
        float(10.0 ** ((spare_dB - threshold_dB) / (10.0 * radio.path_loss_exponent)))
        for threshold_dB in rate_table(radio).snr_min_dB
    ]


def isolated_links() -> Iterator[Row]:
    """Yield how many isolated links near a threshold have a factor other than 1."""
    for is_on in (False, True):
        for margin_dB in MARGINS_dB:
            radio = replace(Radio(), capture_margin_dB=margin_dB, rts_cts=is_on)
            deviations = sum(
                _isolated_deviates(distance_m * (1.0 + side * STEP_ASIDE), index, side, radio)
                for index, distance_m in enumerate(threshold_distances_m(radio))
                for side in (-1, 1)
            )
            case = f"margin {margin_dB:g} dB, RTS/CTS {'on' if is_on else 'off'}"
            quantity = "deviations of 24"
            yield compared("isolated link", case, quantity, 0, "exact", deviations, 0.0)


def _isolated_deviates(distance_m: float, index: int, side: int, radio: Radio) -> bool:
    """Return whether a link just inside (-1) or outside (1) a threshold is not as it should be."""
    context = _context(single(distance_m).network(), radio)
    rates_Mbps = (0.0, *rate_table(radio).rate_Mbps)
    expected_MBps = station_goodput_MBps(
        1, rates_Mbps[index + 1 if side < 0 else index], AxTiming(radio.rts_cts)
    )
    (bandwidth_MBps,) = WifiLinkModel(context).rate_links(context.network).bandwidth_MBps
    model = csma_bianchi(context)
    (factor,) = model.factors([0], [0])
    _, session_factors = model.open_session().update([0], [])
    return bandwidth_MBps != expected_MBps or factor != 1.0 or list(session_factors) != []


def local_shares() -> Iterator[Row]:
    """Yield that local shares stay within 1/(1+d), and that those can be realised.

    Source: Appendix A, Eq. 20.
    """
    random_source = random.Random(1)
    largest = max(_largest_share(random_source) for _ in range(SCENES))
    case = f"{SCENES} random scenes"
    head = "local shares"
    yield compared(head, case, "service (1 + d)", 1.0, "Eq. 20", largest, 0.0, "<=")
    for name, neighbours in GRAPHS.items():
        worst = max(
            abs(chance - 1.0 / (1.0 + len(neighbours[vertex])))
            for vertex, chance in enumerate(chances_to_come_first(neighbours))
        )
        yield compared(head, name, "P(first) - 1/(1+d)", 0.0, "exact", worst, 1e-12)


GRAPHS = {
    "path of 5": ((1,), (0, 2), (1, 3), (2, 4), (3,)),
    "cycle of 5": ((1, 4), (0, 2), (1, 3), (2, 4), (0, 3)),
    "star of 5": ((1, 2, 3, 4), (0,), (0,), (0,), (0,)),
}


def chances_to_come_first(neighbours: tuple[tuple[int, ...], ...]) -> list[float]:
    """Return how often each vertex precedes all its neighbours in a random order.

    Source: Appendix A, "Meaning of local conflict shares".
    """
    orders = list(permutations(range(len(neighbours))))
    wins = [0] * len(neighbours)
    for order in orders:
        for vertex, others in enumerate(neighbours):
            wins[vertex] += all(order[vertex] < order[other] for other in others)
    return [count / len(orders) for count in wins]


def _largest_share(random_source: random.Random) -> float:
    """Return the largest normalised service times (1 + d) in a random scene."""
    senders_m = [
        (random_source.uniform(0, FIELD_m), random_source.uniform(0, FIELD_m))
        for _ in range(LINKS_PER_SCENE)
    ]
    receivers_m = [(x_m + random_source.uniform(5, 60), y_m) for x_m, y_m in senders_m]
    network = Scene(tuple(senders_m), tuple(receivers_m), ()).network()
    radio = Radio()
    context = _context(network, radio)
    links = range(LINKS_PER_SCENE)
    factors = csma_bianchi(context).factors(links, links)
    bandwidths_MBps = WifiLinkModel(context).rate_links(network).bandwidth_MBps
    raw_MBps = WifiLinkModel(context, rate="raw_phy").rate_links(network).bandwidth_MBps
    degrees: list[int] = relations(context, radio).conflict_counts.tolist()
    shares = [
        float(factors[i]) * bandwidths_MBps[i] / raw_MBps[i] * (1 + degrees[i]) for i in links
    ]
    return max(shares)


def _context(network: Network, radio: Radio) -> BuildContext:
    return BuildContext(network, sections={"rf": vars(radio)}, cache=ModelCache())
