"""The figures of the paper's validation, drawn from the same numbers as the rows."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Literal, TypeAlias

import matplotlib as mpl
import numpy as np

mpl.use("Agg")

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from ncsim_core.trace.files import appearing
from ncsim_core.units import MEGABITS_PER_MEGABYTE

from ncsim_wifi.phy.mcs import rate_table
from ncsim_wifi.phy.sensing import carrier_sensing_range_m
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation import fluid
from ncsim_wifi.validation.analysis import threshold_distances_m
from ncsim_wifi.validation.engine_runs import FIXED_CAPTURE, RAW_PHY, measure
from ncsim_wifi.validation.internal import EXP2_SEPARATIONS_m
from ncsim_wifi.validation.literature import saturation_throughput
from ncsim_wifi.validation.packet import (
    predicted_contention_MBps,
    predicted_separation_MBps,
    predicted_starts_and_stops,
)
from ncsim_wifi.validation.rows import read_data
from ncsim_wifi.validation.scenes import parallel, single

MODEL, SECOND, THIRD, ENGINE = "#0072B2", "#D55E00", "#009E73", "#D55E00"
PACKETS, GREY = "#000000", "#777777"
Corner: TypeAlias = Literal["upper right", "lower right", "lower left"]

STEP_s = 0.05
STEPS_s = [0.5 + STEP_s * step for step in range(101)]
READING_ERROR = 0.0017  # two pixels of Bianchi's figure
DPI = 300
MARKERS = {"A": ("s", 8.0), "B": ("o", 4.0)}  # both are seen where they coincide
HEADROOM = 1.12  # of the vertical axis above the largest value


def write_figures(folder: Path) -> list[Path]:
    """Write all figures as PNG into a folder; return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    drawings: Mapping[str, Callable[[], Figure]] = {
        "experiment_1": experiment_1,
        "experiment_2": experiment_2,
        "bianchi_figure_6": bianchi_figure_6,
        "ns3": ns3,
        "starts_and_stops": starts_and_stops,
    }
    paths = []
    with mpl.rc_context({"font.size": 9, "axes.titlesize": 10, "legend.fontsize": 8}):
        for name, draw in drawings.items():
            path = folder / f"{name}.png"
            with appearing(path) as place:
                draw().savefig(place, dpi=DPI, format="png")
            paths.append(path)
    return paths


def experiment_1() -> Figure:
    """Return PHY rate against link length (Figure ``fig:exp1``)."""
    figure, (axes,) = _panels(1)
    table, ends_m = rate_table(Radio()), threshold_distances_m(Radio())[::-1]
    rates_MBps = [rate / MEGABITS_PER_MEGABYTE for rate in reversed(table.rate_Mbps)]
    axes.stairs([*rates_MBps, 0.0], [0.0, *ends_m, 150.0], color=MODEL, lw=1.5, label="Eq. 4")
    for mcs, (rate_MBps, end_m) in enumerate(
        zip(reversed(rates_MBps), reversed(ends_m), strict=True)
    ):
        axes.annotate(
            f"{mcs}",
            (end_m, rate_MBps),
            (3, 0),
            textcoords="offset points",
            va="center",
            fontsize=7,
            color=MODEL,
        )
    printed = read_data("paper_tables")["exp1"]
    lengths_m = [each["distance_m"] for each in printed]
    measured_MBps = [measure(single(at), "none", RAW_PHY).mean_rate_MBps(0) for at in lengths_m]
    axes.plot(lengths_m, measured_MBps, "o", color=ENGINE, ms=5, label="transfer in the engine")
    axes.set_xlim(0.0, 150.0)
    title = "One link, 802.11ax, 20 MHz; numbers are MCS"
    _label(axes, title, "Link length (m)", "PHY rate (MB/s)")
    return figure


def experiment_2() -> Figure:
    """Return the rate of two parallel links against separation (Figure ``fig:exp2``)."""
    figure, (axes,) = _panels(1)
    _draw(axes, _curve_MBps(fluid.effective_rate_factor), "-", MODEL, "analytical")
    axes.plot(
        EXP2_SEPARATIONS_m,
        [measure(parallel(2, s)).mean_rate_MBps(0) for s in EXP2_SEPARATIONS_m],
        "o",
        color=ENGINE,
        ms=5,
        label="transfer in the engine",
    )
    _mark_sensing_range(axes)
    _label(axes, "Two parallel 30 m links", "Separation (m)", "Rate per link (MB/s)", "lower right")
    return figure


def bianchi_figure_6() -> Figure:
    """Return saturation throughput against stations with the markers read from Bianchi."""
    figure, (axes,) = _panels(1)
    points = read_data("bianchi_fig6")["points"]
    stations = range(5, 51)
    for (window, stage), colour, shape in (((32, 5), MODEL, "o"), ((128, 3), SECOND, "s")):
        curve = [saturation_throughput(n, window, stage) for n in stations]
        axes.plot(stations, curve, color=colour, label=f"solver, W = {window}, m = {stage}")
        markers = [each for each in points if (each["W"], each["m"]) == (window, stage)]
        axes.errorbar(
            [each["n"] for each in markers],
            [each["digitised"] for each in markers],
            yerr=READING_ERROR,
            fmt=shape,
            markersize=4,
            markerfacecolor="white",
            color=colour,
            capsize=3,
            label=f"Bianchi (2000), \N{PLUS-MINUS SIGN}{READING_ERROR}",
        )
    title = "Saturation throughput, FHSS at 1 Mb/s, basic access"
    _label(axes, title, "Number of stations", "Normalised throughput S", "lower left")
    axes.set_ylim(0.56, 0.86)
    axes.set_xticks(range(5, 51, 5))
    return figure


def ns3() -> Figure:
    """Return both packet comparisons (Figure ``fig:ns3_validation``)."""
    figure, (left, right) = _panels(2)
    packets, goodput = read_data("ns3_published"), "Goodput per link (MB/s)"
    _draw(left, predicted_contention_MBps(), "o-", MODEL, "ncsim")
    _draw(left, packets["contention_5m_spacing"], "s", PACKETS, "ns-3, mean of 20 seeds")
    _label(left, "(a) Parallel 30 m links, 5 m apart", "Number of links", goodput)
    _draw(right, _curve_MBps(fluid.effective_rate_factor), ":", MODEL, "ncsim, effective_rate")
    _draw(right, _curve_MBps(fluid.fixed_capture_factor), "-", SECOND, "")
    captured = predicted_separation_MBps(FIXED_CAPTURE)
    _draw(right, captured, "D", SECOND, "ncsim, fixed_capture")
    spatial = predicted_separation_MBps("csma_spatial")
    _draw(right, spatial, "^--", THIRD, "ncsim, csma_spatial")
    _draw(right, packets["two_links_by_separation_m"], "s", PACKETS, "ns-3, mean of 20 seeds")
    _mark_sensing_range(right)
    _label(right, "(b) Two parallel 30 m links", "Separation (m)", goodput, "lower right")
    return figure


def starts_and_stops() -> Figure:
    """Return the rates of two links while the second starts and stops (``fig:dynamic_packet``)."""
    figure, panels = _panels(2)
    names = {40: "(a) 40 m apart: they hear each other", 80: "(b) 80 m apart: hidden"}
    for axes, (separation_m, title) in zip(panels, names.items(), strict=True):
        rates = predicted_starts_and_stops(separation_m)
        for flow, (colour, style) in enumerate(((MODEL, "-"), (SECOND, "--"))):
            steps = [rates.mean_rate_MBps(flow, at, at + STEP_s) for at in STEPS_s[:-1]]
            label = f"{'AB'[flow]}, ncsim"
            axes.stairs(steps, STEPS_s, color=colour, ls=style, baseline=None, label=label)
            _draw_windows(axes, separation_m, "AB"[flow], colour)
        _label(axes, title, "Time (s)", "Goodput (MB/s)", None)
        axes.set_xlim(STEPS_s[0], STEPS_s[-1])
        axes.set_ylim(-0.1, 4.2)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def _draw_windows(axes: Axes, separation_m: int, letter: str, colour: str) -> None:
    """Draw medians and quartiles of packets over their windows."""
    label, (shape, size) = f"{letter}, ns-3: median and quartiles", MARKERS[letter]
    for each in read_data("paper_tables")["dynamic"]:
        if (each["separation_m"], each["link"]) == (separation_m, letter):
            start_s, end_s = each["window_s"]
            median_MBps, (low_MBps, high_MBps) = each["ns3_median_MBps"], each["ns3_iqr_MBps"]
            axes.errorbar(
                (start_s + end_s) / 2.0,
                median_MBps,
                xerr=(end_s - start_s) / 2.0,
                yerr=[[median_MBps - low_MBps], [high_MBps - median_MBps]],
                fmt=shape,
                markersize=size,
                markerfacecolor="none",
                color=colour,
                capsize=2,
                label=label or None,
            )
            label = ""


def _curve_MBps(factor: fluid.Factor) -> dict[str, float]:
    """Return the rate of one of two parallel links at many separations."""
    separations_m = np.linspace(5.0, 200.0, 781).tolist()
    return {str(at): fluid.rates_MBps((0, 1), parallel(2, at), factor)[0] for at in separations_m}


def _panels(count: int) -> tuple[Figure, list[Axes]]:
    figure = Figure(figsize=(5.0 * count, 3.4), layout="constrained")
    return figure, [figure.add_subplot(1, count, number + 1) for number in range(count)]


def _draw(axes: Axes, values: Mapping[str, float], style: str, colour: str, label: str) -> None:
    at, heights = [float(key) for key in values], list(values.values())
    axes.plot(at, heights, style, color=colour, markersize=4.5, linewidth=1.5, label=label or None)


def _mark_sensing_range(axes: Axes) -> None:
    range_m = carrier_sensing_range_m(Radio())
    label = f"carrier-sensing range, {range_m:.1f} m"
    axes.axvline(range_m, color=GREY, linestyle="--", linewidth=0.8, label=label)


def _label(
    axes: Axes, title: str, x_label: str, y_label: str, legend_at: Corner | None = "upper right"
) -> None:
    axes.set_title(title)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.set_ylim(0.0, HEADROOM * axes.dataLim.ymax)
    axes.grid(visible=True, alpha=0.3, linewidth=0.5)
    if legend_at is not None:
        axes.legend(loc=legend_at)
