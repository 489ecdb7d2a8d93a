"""Stage 1: experiments of the paper and its regression suite, engine against definitions."""

from collections.abc import Iterator, Mapping
from functools import partial

from ncsim_wifi.mac.efficiency import efficiency
from ncsim_wifi.mac.timing import AxTiming
from ncsim_wifi.phy.mcs import rate_table
from ncsim_wifi.phy.path_loss import path_loss_dB, reference_loss_dB
from ncsim_wifi.phy.received_power import received_power_dBm, snr_dB
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation import analysis, fluid
from ncsim_wifi.validation.engine_runs import RAW_PHY, measure
from ncsim_wifi.validation.rows import Row, half_a_digit, read_data
from ncsim_wifi.validation.scenes import Flow, Scene, parallel, single

compared = partial(Row, "internal")

LENGTHS_m = (1.0, *(5.0 * i for i in range(1, 29)))
EXP2_SEPARATIONS_m = (5, 10, 20, 30, 40, 50, 60, 70, 75, 80, 90, 100, 120, 150, 200)
EXP4_SEPARATIONS_m = (10, 20, 30, 35, 40, 50, 60, 70, 75, 100, 150)
EXP4_SIZE_MB = 10.0
MAX_TIME_ERROR_s = 4e-6  # Section VI-A, Experiment 4
MAX_RATE_ERROR_MBps = 1e-6
RATE_DIGITS = half_a_digit(3) + MAX_RATE_ERROR_MBps  # 14.3375 is printed as 14.338


def rows() -> Iterator[Row]:
    """Yield all comparisons of the stage."""
    yield from analysis.constants()
    yield from analysis.solver()
    yield from analysis.isolated_links()
    yield from analysis.local_shares()
    yield from experiment_1()
    yield from experiment_2()
    yield from experiment_4()
    yield from experiment_7()
    yield from other_experiments()


def snr_at_dB(distance_m: float, radio: Radio) -> float:
    """Return the signal-to-noise ratio over a distance."""
    loss_dB = path_loss_dB(distance_m, reference_loss_dB(radio.freq_ghz), radio.path_loss_exponent)
    return snr_dB(received_power_dBm(radio.tx_power_dBm, loss_dB), radio.noise_floor_dBm)


def experiment_1() -> Iterator[Row]:
    """Yield PHY rate against link length (Table ``tab:exp1``)."""
    radio = Radio()
    for printed in read_data("paper_tables")["exp1"]:
        distance_m = float(printed["distance_m"])
        head = ("1 link length", f"{distance_m:g} m")
        ratio_dB = snr_at_dB(distance_m, radio)
        yield compared(*head, "SNR dB", printed["snr_dB"], "paper", ratio_dB, half_a_digit(2))
        mcs = -1 if printed["mcs"] is None else printed["mcs"]
        measured_mcs = rate_table(radio).index_for(ratio_dB)
        yield compared(*head, "MCS (-1: none)", mcs, "paper", measured_mcs, 0.0)
        rate_MBps = measure(single(distance_m), "none", RAW_PHY).mean_rate_MBps(0)
        yield compared(*head, "rate MB/s", printed["rate_MBps"], "paper", rate_MBps, RATE_DIGITS)
    yield from _all_lengths()


def _all_lengths() -> Iterator[Row]:
    """Yield the largest deviation of the simulated from the selected rate, 1 to 140 m."""
    radio, rates_Mbps = Radio(), (0.0, *rate_table(Radio()).rate_Mbps)
    deviations_MBps = []
    for length_m in LENGTHS_m:
        chosen = rate_table(radio).index_for(snr_at_dB(length_m, radio))
        rate_MBps = measure(single(length_m), "none", RAW_PHY).mean_rate_MBps(0)
        deviations_MBps.append(abs(rate_MBps - rates_Mbps[chosen + 1] / 8.0))
    case, quantity = f"{len(LENGTHS_m)} lengths, 1 to 140 m", "deviation MB/s"
    limit, largest = MAX_RATE_ERROR_MBps, max(deviations_MBps)
    yield compared("1 link length", case, quantity, limit, "Eq. 4", largest, 0.0, "<=")


def experiment_2() -> Iterator[Row]:
    """Yield the rate of two parallel links against their separation (Figure ``fig:exp2``)."""
    bands = read_data("paper_tables")["exp2"]
    for separation_m in EXP2_SEPARATIONS_m:
        (printed_MBps,) = (
            band["rate_MBps"] for band in bands if band["from_m"] <= separation_m <= band["to_m"]
        )
        head = ("2 two parallel links", f"{separation_m} m")
        yield from _mean_rates(head, parallel(2, separation_m), printed_MBps)


def experiment_4() -> Iterator[Row]:
    """Yield three parallel links at eleven separations (Table ``tab:exp4``)."""
    printed = {each["separation_m"]: each for each in read_data("paper_tables")["exp4"]}
    for separation_m in EXP4_SEPARATIONS_m:
        scene = parallel(3, separation_m, [Flow(i, EXP4_SIZE_MB) for i in range(3)])
        name, case = "4 three parallel links", f"{separation_m} m"
        yield from against_fluid(name, case, scene, "ABC")
        measured = measure(scene)
        for flow, letter in enumerate("AB" if separation_m in printed else ""):
            expected_MBps = printed[separation_m][f"rate_{letter}_MBps"]
            quantity, rate_MBps = f"mean rate {letter} MB/s", measured.mean_rate_MBps(flow)
            yield compared(name, case, quantity, expected_MBps, "paper", rate_MBps, RATE_DIGITS)


def experiment_7() -> Iterator[Row]:
    """Yield n links in one contention domain (Table ``tab:exp7``)."""
    clean_Mbps = 68.8
    for printed in read_data("paper_tables")["exp7"]:
        n = printed["links"]
        head = ("7 contention", f"n = {n}")
        eta = efficiency(n, clean_Mbps, AxTiming())
        yield compared(*head, "eta", printed["efficiency"], "paper", eta, half_a_digit(3))
        share = printed["efficiency_per_link"]
        yield compared(*head, "eta / n", share, "paper", eta / n, half_a_digit(3))
        yield from _mean_rates(head, parallel(n, 5.0), printed["rate_MBps"])


def other_experiments() -> Iterator[Row]:
    """Yield the five further experiments that the paper names, each against the fluid."""
    for name, cases in OTHER_EXPERIMENTS.items():
        for case, scene in cases.items():
            yield from against_fluid(name, case, scene)


def _to_one_receiver(one_m: float, other_m: float, radio: Radio = Radio()) -> Scene:  # noqa: B008 - frozen
    """Return two links to one receiver, from opposite sides."""
    flows = (Flow(0, 10.0), Flow(1, 20.0))
    return Scene(((-one_m, 0.0), (other_m, 0.0)), ((0.0, 0.0), (0.0, 0.0)), flows, radio)


OTHER_EXPERIMENTS: Mapping[str, Mapping[str, Scene]] = {
    "3 shared receiver": {
        "30 and 30 m": _to_one_receiver(30.0, 30.0),
        "20 and 60 m": _to_one_receiver(20.0, 60.0),
        "80 and 80 m, deaf to each other": _to_one_receiver(80.0, 80.0),
        "80 and 80 m, RTS/CTS": _to_one_receiver(80.0, 80.0, Radio(rts_cts=True)),
    },
    "5 staggered starts": {
        "40 m; 0, 1, 2.5 s": parallel(
            3, 40.0, [Flow(0, 10.0), Flow(1, 10.0, 1.0), Flow(2, 10.0, 2.5)]
        ),
        "80 m; 0, 1, 2.5 s": parallel(
            3, 80.0, [Flow(0, 10.0), Flow(1, 10.0, 1.0), Flow(2, 10.0, 2.5)]
        ),
    },
    "6 same-link sharing": {
        "3 flows": parallel(1, 0.0, [Flow(0, 5.0), Flow(0, 10.0), Flow(0, 15.0, 1.0)]),
    },
    "8 hidden cascade": {
        "5 links, 75 m": parallel(5, 75.0, [Flow(i, 5.0 * (i + 1)) for i in range(5)]),
        "5 links, 100 m": parallel(5, 100.0, [Flow(i, 5.0 * (i + 1)) for i in range(5)]),
        "5 links of 100 m, 75 m: pauses": parallel(
            5, 75.0, [Flow(i, 2.0 * (5 - i)) for i in range(5)], length_m=100.0
        ),
    },
    "9 sharing and hidden": {
        "2 + 1 flows, 75 m": parallel(2, 75.0, [Flow(0, 10.0), Flow(0, 5.0, 1.0), Flow(1, 10.0)]),
        "2 + 1 + 2 flows, 60 m": parallel(
            3,
            60.0,
            [Flow(0, 10.0), Flow(0, 5.0), Flow(1, 10.0), Flow(2, 8.0), Flow(2, 4.0, 2.0)],
        ),
    },
}


def against_fluid(
    experiment: str, case: str, scene: Scene, letters: str = "123456789"
) -> Iterator[Row]:
    """Yield when each flow of a scene ends, in the engine and in the fluid."""
    measured = measure(scene)
    for flow, expected_s in enumerate(fluid.ends_s(scene)):
        quantity, end_s = f"end of {letters[flow]} s", measured.end_s(flow)
        yield compared(experiment, case, quantity, expected_s, "fluid", end_s, MAX_TIME_ERROR_s)


def _mean_rates(head: tuple[str, str], scene: Scene, printed_MBps: float) -> Iterator[Row]:
    """Yield the mean rate of the first flow in the engine, against the fluid and the paper."""
    rate_MBps = measure(scene).mean_rate_MBps(0)
    expected_MBps = scene.flows[0].size_MB / fluid.ends_s(scene)[0]
    quantity = "rate MB/s"
    yield compared(*head, quantity, expected_MBps, "fluid", rate_MBps, MAX_RATE_ERROR_MBps)
    yield compared(*head, quantity, printed_MBps, "paper", rate_MBps, RATE_DIGITS)
