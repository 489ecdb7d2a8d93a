"""Stage 3: what ncsim predicts against what ns-3 measured, with the errors the model has."""

from collections.abc import Iterator, Mapping
from functools import cache
from statistics import fmean

from ncsim_wifi.mac.efficiency import station_goodput_MBps
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.phy.mcs import rate_table
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation import spatial_packets
from ncsim_wifi.validation.engine_runs import FIXED_CAPTURE, RateLog, measure
from ncsim_wifi.validation.rows import Row, half_a_digit, read_data
from ncsim_wifi.validation.scenes import Flow, parallel

CONTENTION_SPACING_m = 5.0
OVERLAP_SPACING_m = 60.0
RATIO_SEPARATION_m, RECOVERY_SEPARATION_m = "80", "120"
MEDIAN_DIGITS = 2
HIDDEN_SEPARATION_m = 80
A_START_s, B_START_s, B_END_s = 0.5, 2.0, 4.0


def rows() -> Iterator[Row]:
    """Yield all comparisons of the stage."""
    yield from contention()
    yield from separation()
    yield from overlapping_domains()
    yield from overhead()
    yield from starts_and_stops()
    yield from spatial()


def relative_errors(
    predicted: Mapping[str, float], packets: Mapping[str, float]
) -> dict[str, float]:
    """Return |predicted - packets| / packets by setting.

    Source: Section VI-C (``sec:ns3_validation``).
    """
    return {key: abs(predicted[key] - mean) / mean for key, mean in packets.items()}


def predicted_contention_MBps() -> dict[str, float]:
    """Return the rate per link of n links in one contention domain, by n."""
    return {
        str(n): measure(parallel(n, CONTENTION_SPACING_m)).mean_rate_MBps(0) for n in range(1, 9)
    }


def predicted_separation_MBps(interference: Mapping[str, object] | str) -> dict[str, float]:
    """Return the rate per link of two links, by separation in metres."""
    return {
        key: measure(parallel(2, float(key)), interference).mean_rate_MBps(0)
        for key in read_data("ns3_published")["two_links_by_separation_m"]
    }


def contention() -> Iterator[Row]:
    """Yield homogeneous contention: mean error 5.1 %, largest 8.2 %."""
    packets = read_data("ns3_published")["contention_5m_spacing"]
    stated = read_data("paper_tables")["packet_errors"]
    predicted = predicted_contention_MBps()
    name = "1 contention"
    for n, mean in packets.items():
        yield _row(name, f"n = {n}", "MB/s per link", mean, predicted[n])
    errors = relative_errors(predicted, packets)
    yield _stated(name, "n = 1", "relative error", stated["isolated_link"], errors["1"], 4)
    yield from _summary(name, errors, stated["contention_mean"], stated["contention_max"])


def separation() -> Iterator[Row]:
    """Yield two links by separation: fixed capture 5.3 % and 12.2 %, the default 2.47-fold."""
    packets = read_data("ns3_published")["two_links_by_separation_m"]
    stated = read_data("paper_tables")["packet_errors"]
    captured = predicted_separation_MBps(FIXED_CAPTURE)
    name = "2 separation, fixed_capture"
    for key, mean in packets.items():
        yield _row(name, f"{key} m", "MB/s per link", mean, captured[key])
    for key, expected_MBps in stated["fixed_capture_MBps"].items():
        yield _stated(name, f"{key} m", "MB/s per link", expected_MBps, captured[key], 2)
    errors = relative_errors(captured, packets)
    yield from _summary(name, errors, stated["fixed_capture_mean"], stated["fixed_capture_max"])
    default = predicted_separation_MBps("csma_bianchi")
    name = "2 separation, effective_rate"
    for key, mean in packets.items():
        yield _row(name, f"{key} m", "MB/s per link", mean, default[key])
    ratio = default[RATIO_SEPARATION_m] / packets[RATIO_SEPARATION_m]
    yield _stated(name, "80 m", "model over packets", stated["default_ratio_at_80_m"], ratio, 2)
    error = relative_errors(default, packets)[RECOVERY_SEPARATION_m]
    yield _stated(name, "120 m", "relative error", stated["default_error_at_120_m"], error, 3)


def overlapping_domains() -> Iterator[Row]:
    """Yield three links of which only neighbours hear each other (``tab:packet_asymmetric``)."""
    measured = measure(parallel(3, OVERLAP_SPACING_m))
    name = "3 overlapping domains"
    for flow, printed in enumerate(read_data("paper_tables")["overlapping_domains"]):
        rate_MBps = measured.rates.first_rate_MBps(flow)
        case = f"link {printed['link']}"
        yield _stated(name, case, "MB/s, all active", printed["ncsim_MBps"], rate_MBps, 3)
        yield from _against_median(name, case, "MB/s, all active", printed, rate_MBps)


def spatial() -> Iterator[Row]:
    """Yield what ``csma_spatial`` makes of structured and random scenes, link by link."""
    yield from spatial_packets.rows()


def overhead() -> Iterator[Row]:
    """Yield isolated links at two forced rates, RTS/CTS off and on (``tab:packet_rates``)."""
    rates_Mbps = rate_table(Radio()).rate_Mbps
    name = "4 overhead"
    for printed in read_data("paper_tables")["overhead"]:
        timing = AxTiming(printed["rts_cts"])
        rate_MBps = station_goodput_MBps(1, rates_Mbps[printed["mcs"]], timing)
        case = f"MCS {printed['mcs']}, RTS {'on' if printed['rts_cts'] else 'off'}"
        yield _stated(name, case, "MB/s", printed["ncsim_MBps"], rate_MBps, 3)
        yield from _against_median(name, case, "MB/s", printed, rate_MBps)


def starts_and_stops() -> Iterator[Row]:
    """Yield the rates of two links before, during and after the second's demand."""
    name, over = "5 starts and stops", []
    for printed in read_data("paper_tables")["dynamic"]:
        separation_m, (start_s, end_s) = printed["separation_m"], printed["window_s"]
        rates = predicted_starts_and_stops(separation_m)
        rate_MBps = rates.mean_rate_MBps("AB".index(printed["link"]), start_s, end_s)
        case = f"{separation_m:g} m, {printed['link']}, {start_s:g}-{end_s:g} s"
        yield _stated(name, case, "MB/s", printed["ncsim_MBps"], rate_MBps, 3)
        yield _row(name, case, "MB/s", printed["ns3_median_MBps"], rate_MBps)
        if separation_m == HIDDEN_SEPARATION_m and B_START_s <= start_s < B_END_s:
            over.append(rate_MBps / printed["ns3_median_MBps"])
    stated = read_data("paper_tables")["packet_errors"]["default_ratio_in_overlap"]
    yield _stated(name, "80 m, A and B, 2.5-3.5 s", "model over packets", stated, fmean(over), 1)


@cache
def predicted_starts_and_stops(separation_m: float) -> RateLog:
    """Return the rates over time of two links, of which B is backlogged from 2 to 4 s only."""
    during_MBps = measure(parallel(2, separation_m)).mean_rate_MBps(1)
    size_MB = during_MBps * (B_END_s - B_START_s)
    flows = [Flow(0, 100.0, A_START_s), Flow(1, size_MB, B_START_s)]
    return measure(parallel(2, separation_m, flows)).rates


def _against_median(
    experiment: str, case: str, quantity: str, printed: Mapping[str, float], rate_MBps: float
) -> Iterator[Row]:
    """Yield the model against a median of packets, and that it errs by no more than the paper says.

    The paper states the 95th percentile over seeds of the error, which exceeds the error against
    the median; and of that, printed to two decimals, only the least it can be is known.
    """
    median_MBps = printed["ns3_median_MBps"]
    yield _row(experiment, case, quantity, median_MBps, rate_MBps)
    nearest_MBps = median_MBps + half_a_digit(MEDIAN_DIGITS) * (
        1.0 if rate_MBps > median_MBps else -1.0
    )
    error = abs(rate_MBps - nearest_MBps) / nearest_MBps
    limit = printed["error_p95"]
    quantity = "error against median"
    yield Row("packet", experiment, case, quantity, limit, "paper, p95", error, 0.0, "<=")


def _row(experiment: str, case: str, quantity: str, packets: float, model: float) -> Row:
    return Row("packet", experiment, case, quantity, packets, "ns-3", model, None)


def _stated(
    experiment: str, case: str, quantity: str, expected: float, measured: float, decimals: int
) -> Row:
    tolerance = half_a_digit(decimals)
    return Row("packet", experiment, case, quantity, expected, "paper", measured, tolerance)


def _summary(
    experiment: str, errors: Mapping[str, float], mean: float, largest: float
) -> Iterator[Row]:
    """Yield that the model's errors are those that the paper states."""
    values = list(errors.values())
    case = f"{len(values)} settings"
    yield _stated(experiment, case, "mean relative error", mean, fmean(values), 3)
    yield _stated(experiment, case, "largest relative error", largest, max(values), 3)
