"""What is booked on one node, and the gaps that a later task may fill."""

import math
from bisect import bisect_left

OVERLAP_TOLERANCE_s = 1e-9  # SAGA's EPS


class Timeline:
    """The bookings of one node in order of time, and the gaps between them.

    Gaps too short for any task of the DAG are dropped: adding is monotone in floating point, so
    what the shortest task cannot fill no task can.

    Args:
        shortest_s: Execution time of the DAG's cheapest task on this node.
    """

    def __init__(self, shortest_s: float) -> None:
        self._shortest_s = shortest_s
        self._busy: list[tuple[float, float]] = []
        self.gap_begins_s: list[float] = [0.0]
        self.gap_ends_s: list[float] = [math.inf]

    def earliest_finish_s(self, ready_s: float, duration_s: float) -> float:
        """Return when a task ends that begins in the first gap that holds it."""
        begins, ends = self.gap_begins_s, self.gap_ends_s
        if ready_s >= begins[-1]:
            return ready_s + duration_s
        for gap in range(bisect_left(ends, ready_s), len(ends)):
            begin_s = begins[gap]
            finish_s = (max(begin_s, ready_s)) + duration_s
            if finish_s <= ends[gap]:
                return finish_s
        return math.inf

    def book(self, begin_s: float, end_s: float) -> tuple[int, int, int]:
        """Book a time, and return how the list of gaps has changed.

        Returns:
            Index of the first gap that changed, how many went (0 or 1), and how many came in
            their place (0 to 2).
        """
        at = self._place_of(begin_s, end_s)
        before_s = self._busy[at - 1][1] if at else 0.0
        after_s = self._busy[at][0] if at < len(self._busy) else math.inf
        self._busy.insert(at, (begin_s, end_s))
        gap = self._gap_between(before_s, after_s)
        if gap is None:
            return 0, 0, 0
        parts = [
            (begin, end)
            for begin, end in ((before_s, begin_s), (end_s, after_s))
            if begin + self._shortest_s <= end
        ]
        self.gap_begins_s[gap : gap + 1] = [begin for begin, _ in parts]
        self.gap_ends_s[gap : gap + 1] = [end for _, end in parts]
        return gap, 1, len(parts)

    def _place_of(self, begin_s: float, end_s: float) -> int:
        """Return where SAGA inserts a booking.

        A beginning computed as end minus duration may come out a bit too early and land before
        a booking of no length. SAGA stops there with an error; here the task goes behind it.
        """
        at = bisect_left(self._busy, (begin_s, end_s))
        while at < len(self._busy) and self._busy[at][0] < end_s - OVERLAP_TOLERANCE_s:
            at += 1
        return at

    def _gap_between(self, before_s: float, after_s: float) -> int | None:
        """Return which gap lies between two neighbouring bookings, if it was kept."""
        for gap in range(bisect_left(self.gap_ends_s, after_s), len(self.gap_ends_s)):
            if self.gap_ends_s[gap] > after_s:
                return None
            if self.gap_begins_s[gap] == before_s:
                return gap
        return None
