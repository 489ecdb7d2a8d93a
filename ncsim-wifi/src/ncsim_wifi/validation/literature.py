"""Stage 2: Bianchi's Table III and Figure 6 with his own parameters."""

from collections.abc import Iterator
from functools import partial

from ncsim_wifi.mac.bianchi import fixed_point
from ncsim_wifi.mac.efficiency import efficiency_at
from ncsim_wifi.mac.timing import FhssTiming
from ncsim_wifi.validation.rows import Row, half_a_digit, read_data

compared = partial(Row, "literature")

FHSS_RATE_Mbps = 1.0
TABLE_WINDOW, TABLE_STAGE = 32, 3
MAX_MARKER_ERROR = 0.0066  # Section VI-B: twelve markers differ by at most 0.66 %


def rows() -> Iterator[Row]:
    """Yield all comparisons of the stage."""
    yield from table_3()
    yield from figure_6()


def saturation_throughput(stations: int, window: int, max_stage: int) -> float:
    """Return Bianchi's normalised saturation throughput S for FHSS at 1 Mb/s.

    Source: Section VI-B (``sec:external_val``).

    >>> round(saturation_throughput(2, 32, 3), 6)
    0.847311
    """
    point = fixed_point(stations, window, max_stage)
    return efficiency_at(point, stations, FHSS_RATE_Mbps, FhssTiming())


def table_3() -> Iterator[Row]:
    """Yield Table III, as this paper computes it and as Bianchi printed it."""
    for printed in read_data("paper_tables")["bianchi_table3"]:
        n = printed["stations"]
        head = ("Bianchi Table III", f"n = {n}, W = 32, m = 3", "S")
        throughput = saturation_throughput(n, TABLE_WINDOW, TABLE_STAGE)
        yield compared(*head, printed["computed"], "paper", throughput, half_a_digit(6))
        yield compared(*head, printed["published"], "Bianchi", throughput, half_a_digit(4))


def figure_6() -> Iterator[Row]:
    """Yield the twelve markers read from Figure 6, and the published curve at them."""
    for point in read_data("bianchi_fig6")["points"]:
        n, window, stage = point["n"], point["W"], point["m"]
        head = ("Bianchi Figure 6", f"n = {n}, W = {window}, m = {stage}", "S")
        throughput = saturation_throughput(n, window, stage)
        yield compared(*head, point["computed"], "curve", throughput, 1e-12)
        tolerance = MAX_MARKER_ERROR * point["digitised"]
        yield compared(*head, point["digitised"], "marker", throughput, tolerance)
