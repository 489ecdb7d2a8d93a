"""``--kind rates``: a staircase per transfer, with what caused each step."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from ncsim_core.errors import ScenarioError
from ncsim_core.sweep.drawing import COLOURS, figure_at
from ncsim_core.trace.run_trace import RateStep, RunTrace, RunTransfer
from ncsim_core.units import s_from_us

from ncsim_viz.figures.words import plain

MAX_ROWS: Final = 40
"""Transfers that a figure shows, the longest; its title says how many there are."""
ROW_in: Final = 0.55
WIDTH_in: Final = 7.0


def draw(run: RunTrace, path: Path) -> None:
    """Draw the rate of each transfer over time, against the rate that it has alone.

    Raises:
        ScenarioError: The trace has no rates, or nothing travelled; or matplotlib is missing.
    """
    if not run.has_rates:
        raise ScenarioError("this trace has no rates: run it again with --trace full")
    transfers = [each for each in run.transfers if each.steps]
    if not transfers:
        raise ScenarioError("no transfer crossed a link in this run; there are no rates to draw")
    shown = _longest(transfers, run)
    with figure_at(path, WIDTH_in, 1.2 + ROW_in * len(shown)) as figure:
        rows = figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0]
        for axes, transfer in zip(rows, shown, strict=True):
            _draw_row(axes, transfer, run)
        rows[-1].set(xlabel="time (s)", xlim=(0, s_from_us(run.end.ended_us) or 1))
        some = f", the {len(shown)} longest of {len(transfers)} transfers"
        title = f"{plain(run.header.scenario or 'run')}: rates"
        figure.suptitle(title if len(shown) == len(transfers) else title + some, fontsize=10)
        _add_legend(figure, rows[0])


def _longest(transfers: Sequence[RunTransfer], run: RunTrace) -> list[RunTransfer]:
    def took_us(transfer: RunTransfer) -> int:
        last_us = run.end.ended_us if transfer.ended_us is None else transfer.ended_us
        return last_us - (transfer.started_us or 0)

    kept = sorted(transfers, key=took_us, reverse=True)[:MAX_ROWS]
    return sorted(kept, key=lambda each: (each.started_us or 0, each.number))


def in_force(transfer: RunTransfer, run: RunTrace) -> list[tuple[RateStep, int]]:
    """Return the steps with their ends, without those replaced at the instant they were set."""
    spans = list(run.rate_spans(transfer))
    return [(step, end_us) for step, end_us in spans if end_us > step.at_us] or spans[-1:]


def _draw_row(axes: Any, transfer: RunTransfer, run: RunTrace) -> None:  # noqa: ANN401
    spans = in_force(transfer, run)
    edges_s = [s_from_us(step.at_us) for step, _ in spans] + [s_from_us(spans[-1][1])]
    rates_MBps = [step.rate_MBps for step, _ in spans]
    axes.stairs(rates_MBps, edges_s, fill=True, color=COLOURS[4], alpha=0.5, label="rate")
    axes.stairs(rates_MBps, edges_s, color=COLOURS[0], linewidth=1.0)
    solo_MBps = run.solo_MBps(transfer)
    axes.plot(
        [edges_s[0], edges_s[-1]],
        [solo_MBps] * 2,
        "--",
        color="0.45",
        linewidth=0.8,
        label="rate alone",
    )
    for change, marker, name in (("s", "^", "another starts"), ("e", "o", "another ends")):
        steps = [step for step, _ in spans if step.change == change]
        axes.plot(
            [s_from_us(step.at_us) for step in steps], [step.rate_MBps for step in steps], marker,
            color="black", markersize=3, markerfacecolor="white", linestyle="none", label=name,
        )  # fmt: skip
    axes.set_ylim(0, solo_MBps * 1.15)
    axes.tick_params(labelsize=6)
    label = plain(run.transfer_label(transfer.number))
    axes.set_ylabel(label, rotation=0, ha="right", va="center", fontsize=7, labelpad=12)


def _add_legend(figure: Any, axes: Any) -> None:  # noqa: ANN401
    handles, labels = axes.get_legend_handles_labels()
    figure.supylabel("rate (MB/s)", fontsize=8)
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
