"""Stage 1: experiments of the paper and its regression suite, engine against definitions."""

from collections.abc import Iterator
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


def experiment_2() -> Iterator[Row]:
    """Yield the rate of two parallel links against their separation (Figure ``fig:exp2``)."""
    bands = read_data("paper_tables")["exp2"]
    for separation_m in EXP2_SEPARATIONS_m:
        scene = parallel(2, separation_m)
        head = ("2 two parallel links", f"{separation_m} m", "rate MB/s")
        rate_MBps = measure(scene).mean_rate_MBps(0)
        expected_MBps = fluid.rates_MBps((0, 1), scene)[0]
        yield compared(*head, expected_MBps, "fluid", rate_MBps, MAX_RATE_ERROR_MBps)
        for band in bands:
            if band["from_m"] <= separation_m <= band["to_m"]:
                yield compared(*head, band["rate_MBps"], "paper", rate_MBps, RATE_DIGITS)


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
        rate_MBps = measure(parallel(n, 5.0)).mean_rate_MBps(0)
        yield compared(*head, "rate MB/s", printed["rate_MBps"], "paper", rate_MBps, RATE_DIGITS)


def other_experiments() -> Iterator[Row]:
    """Yield the five further experiments that the paper names, each against the fluid."""
    shared_receiver = Scene(
        ((0.0, 0.0), (60.0, 0.0)), ((30.0, 0.0), (30.0, 0.0)), (Flow(0, 10.0), Flow(1, 20.0))
    )
    yield from against_fluid("3 shared receiver", "2 senders", shared_receiver)
    staggered = parallel(3, 40.0, [Flow(0, 10.0), Flow(1, 10.0, 1.0), Flow(2, 10.0, 2.5)])
    yield from against_fluid("5 staggered starts", "0, 1, 2.5 s", staggered)
    same_link = single(30.0)
    same_link = Scene(
        same_link.senders_m,
        same_link.receivers_m,
        (Flow(0, 5.0), Flow(0, 10.0), Flow(0, 15.0, 1.0)),
    )
    yield from against_fluid("6 same-link sharing", "3 flows", same_link)
    cascade = parallel(5, 75.0, [Flow(i, 5.0 * (i + 1)) for i in range(5)])
    yield from against_fluid("8 hidden cascade", "5 links, 75 m", cascade)
    both = parallel(2, 75.0, [Flow(0, 10.0), Flow(0, 5.0, 1.0), Flow(1, 10.0)])
    yield from against_fluid("9 sharing and hidden", "2 + 1 flows, 75 m", both)


def against_fluid(
    experiment: str, case: str, scene: Scene, letters: str = "123456789"
) -> Iterator[Row]:
    """Yield when each flow of a scene ends, in the engine and in the fluid."""
    measured = measure(scene)
    for flow, expected_s in enumerate(fluid.ends_s(scene)):
        quantity, end_s = f"end of {letters[flow]} s", measured.end_s(flow)
        yield compared(experiment, case, quantity, expected_s, "fluid", end_s, MAX_TIME_ERROR_s)
