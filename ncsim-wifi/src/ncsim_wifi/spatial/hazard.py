"""How fast interference destroys a frame: the hazard h of a whole payload, loss 1 - exp(-h)."""

import csv
from functools import cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np

from ncsim_wifi.quantities import FloatArray, IntArray
from ncsim_wifi.spatial.elementary import exp

LEFT_SLOPE_PER_dB = -2.3
RIGHT_SLOPE_PER_dB = -2.8
LOWEST_LN, HIGHEST_LN = -40.0, 7.0
GRID_STEPS_PER_dB = 100
GRID_FROM_dB, GRID_TO_dB = -25.0, 60.0


class HazardTable(NamedTuple):
    """Points of the curves, one row per modulation and coding scheme.

    Args:
        ln_hazard: ln h of each column, falling.
        ratio_dB: The ratio at which a scheme has that hazard, shape (schemes, columns).
    """

    ln_hazard: FloatArray
    ratio_dB: FloatArray


@cache
def hazard_table() -> HazardTable:
    """Return the points of the curves for a PSDU of 1542 bytes.

    Source: MODEL 1, Table A; read from the table-based error model of ns-3.44.
    """
    text = (files("ncsim_wifi.spatial") / "hazards.csv").read_text("utf-8")
    header, *rows = csv.reader(text.splitlines())
    return HazardTable(
        np.log([float(value) for value in header[1:]]),
        np.array([[float(value) for value in row[1:]] for row in rows]),
    )


@cache
def hazard_grid() -> FloatArray:
    """Return ln h on an even grid of ratios, shape (schemes, steps); all points lie on it."""
    steps = round((GRID_TO_dB - GRID_FROM_dB) * GRID_STEPS_PER_dB)
    ratios_dB = GRID_FROM_dB + np.arange(steps + 2) / GRID_STEPS_PER_dB
    table = hazard_table()
    rows = []
    for points_dB in table.ratio_dB:
        row = np.interp(ratios_dB, points_dB, table.ln_hazard)
        row += LEFT_SLOPE_PER_dB * np.minimum(0.0, ratios_dB - points_dB[0])
        row += RIGHT_SLOPE_PER_dB * np.maximum(0.0, ratios_dB - points_dB[-1])
        rows.append(np.clip(row, LOWEST_LN, HIGHEST_LN))
    return np.array(rows)


def hazard(scheme: IntArray, ratio_dB: FloatArray) -> FloatArray:
    """Return h of whole payloads received at a constant ratio.

    Args:
        scheme: Row of the table; broadcasts against ``ratio_dB``.
        ratio_dB: Signal to interference and noise.
    """
    return exp(ln_hazard(scheme, ratio_dB))


def ln_hazard(scheme: IntArray, ratio_dB: FloatArray) -> FloatArray:
    """Return the logarithm of the hazard.

    The curves are read from a grid of 0.01 dB, on which all points of Table A lie.

    Source: MODEL 1, frame loss.

    Args:
        scheme: Row of the table; broadcasts against ``ratio_dB``.
        ratio_dB: Signal to interference and noise.
    """
    within_dB = np.minimum(np.maximum(ratio_dB, GRID_FROM_dB), GRID_TO_dB)
    at = (within_dB - GRID_FROM_dB) * GRID_STEPS_PER_dB
    below = at.astype(np.int64)
    grid = hazard_grid()
    place = scheme * grid.shape[1] + below
    result = grid.take(place)
    result += (at - below) * (grid.take(place + 1) - result)
    return np.asarray(result)
