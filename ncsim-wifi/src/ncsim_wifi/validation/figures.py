"""The figures of the paper's validation, drawn from the same numbers as the rows."""

from collections.abc import Callable, Mapping
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ncsim_wifi.phy.mcs import rate_table
from ncsim_wifi.phy.sensing import carrier_sensing_range_m
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation import fluid
from ncsim_wifi.validation.engine_runs import FIXED_CAPTURE, RAW_PHY, measure
from ncsim_wifi.validation.internal import EXP2_SEPARATIONS_m, snr_at_dB
from ncsim_wifi.validation.literature import saturation_throughput
from ncsim_wifi.validation.packet import (
    predicted_contention_MBps,
    predicted_separation_MBps,
)
from ncsim_wifi.validation.rows import read_data
from ncsim_wifi.validation.scenes import parallel, single

MODEL, SECOND, PACKETS, GREY = "#1f5fa8", "#d1782b", "#222222", "#8a8a8a"
READING_ERROR = 0.0017  # two pixels of Bianchi's figure
DPI = 150


def write_figures(folder: Path) -> list[Path]:
    """Write all figures as PNG into a folder; return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    drawings: Mapping[str, Callable[[], Figure]] = {
        "experiment_1": experiment_1,
        "experiment_2": experiment_2,
        "bianchi_figure_6": bianchi_figure_6,
        "ns3": ns3,
    }
    paths = []
    for name, draw in drawings.items():
        path = folder / f"{name}.png"
        draw().savefig(path, dpi=DPI)
        paths.append(path)
    return paths


def experiment_1() -> Figure:
    """Return PHY rate against link length (Figure ``fig:exp1``)."""
    figure, (axes,) = _panels(1)
    radio, table = Radio(), rate_table(Radio())
    lengths_m = np.linspace(1.0, 145.0, 2000)
    rates_MBps = [
        ([0.0, *table.rate_Mbps])[table.index_for(snr_at_dB(float(at), radio)) + 1] / 8.0
        for at in lengths_m
    ]
    axes.step(lengths_m, rates_MBps, where="post", color=MODEL, label="selected by SNR")
    printed = read_data("paper_tables")["exp1"]
    axes.plot(
        [each["distance_m"] for each in printed],
        [
            measure(single(each["distance_m"]), "none", RAW_PHY).mean_rate_MBps(0)
            for each in printed
        ],
        "o",
        color="#c0392b",
        label="transfer in the engine",
    )
    _label(
        axes, "Experiment 1: 802.11ax, 20 MHz, 5 GHz, n = 3", "link length (m)", "PHY rate (MB/s)"
    )
    return figure


def experiment_2() -> Figure:
    """Return the rate of two parallel links against separation (Figure ``fig:exp2``)."""
    figure, (axes,) = _panels(1)
    _draw(axes, _curve_MBps(fluid.effective_rate_factor), "-", MODEL, "analytical")
    axes.plot(
        EXP2_SEPARATIONS_m,
        [measure(parallel(2, s)).mean_rate_MBps(0) for s in EXP2_SEPARATIONS_m],
        "o",
        color="#c0392b",
        label="transfer in the engine",
    )
    _mark_sensing_range(axes)
    _label(axes, "Experiment 2: two parallel 30 m links", "separation (m)", "rate per link (MB/s)")
    return figure


def bianchi_figure_6() -> Figure:
    """Return saturation throughput against stations with the markers read from Bianchi."""
    figure, (axes,) = _panels(1)
    points = read_data("bianchi_fig6")["points"]
    stations = range(5, 51)
    for (window, stage), colour in (((32, 5), MODEL), ((128, 3), SECOND)):
        curve = [saturation_throughput(n, window, stage) for n in stations]
        axes.plot(stations, curve, color=colour, label=f"solver, W = {window}, m = {stage}")
        markers = [each for each in points if (each["W"], each["m"]) == (window, stage)]
        axes.errorbar(
            [each["n"] for each in markers],
            [each["digitised"] for each in markers],
            yerr=READING_ERROR,
            fmt="o",
            markersize=5,
            markerfacecolor="white",
            color=colour,
            capsize=3,
            label=f"Bianchi (2000), W = {window}",
        )
    _label(axes, "Bianchi's Figure 6", "stations", "normalised saturation throughput S")
    axes.set_ylim(0.55, 0.87)
    return figure


def ns3() -> Figure:
    """Return both packet comparisons (Figure ``fig:ns3_validation``)."""
    figure, (left, right) = _panels(2)
    packets = read_data("ns3_published")
    means = packets["contention_5m_spacing"]
    _draw(left, means, "s", PACKETS, "ns-3")
    _draw(left, predicted_contention_MBps(), "o-", MODEL, "ncsim")
    _label(left, "(a) contention, 5 m spacing", "links", "goodput per link (MB/s)")
    _draw(right, packets["two_links_by_separation_m"], "s", PACKETS, "ns-3")
    captured = predicted_separation_MBps(FIXED_CAPTURE)
    _draw(right, captured, "D", SECOND, "ncsim, fixed_capture")
    _draw(right, _curve_MBps(fluid.fixed_capture_factor), "-", SECOND, "")
    _draw(right, _curve_MBps(fluid.effective_rate_factor), ":", MODEL, "ncsim, effective_rate")
    _mark_sensing_range(right)
    _label(right, "(b) two links", "separation (m)", "goodput per link (MB/s)")
    return figure


def _curve_MBps(factor: fluid.Factor) -> dict[str, float]:
    """Return the rate of one of two parallel links at many separations."""
    separations_m = np.linspace(5.0, 200.0, 781).tolist()
    return {str(at): fluid.rates_MBps((0, 1), parallel(2, at), factor)[0] for at in separations_m}


def _panels(count: int) -> tuple[Figure, list[Axes]]:
    figure = Figure(figsize=(6.0 * count, 4.0), layout="constrained")
    return figure, [figure.add_subplot(1, count, number + 1) for number in range(count)]


def _draw(axes: Axes, values: Mapping[str, float], style: str, colour: str, label: str) -> None:
    axes.plot(
        [float(key) for key in values],
        list(values.values()),
        style,
        color=colour,
        markersize=5,
        label=label or None,
    )


def _mark_sensing_range(axes: Axes) -> None:
    axes.axvline(
        carrier_sensing_range_m(Radio()), color=GREY, linestyle="--", linewidth=1, label="71.2 m"
    )


def _label(axes: Axes, title: str, x_label: str, y_label: str) -> None:
    axes.set_title(title, fontsize=11)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.set_ylim(bottom=0.0)
    axes.grid(visible=True, alpha=0.3)
    axes.legend(fontsize=9)
