"""Gaps between the bookings of a node."""

import math
from itertools import pairwise

from hypothesis import given, settings
from hypothesis import strategies as st
from ncsim_saga.native.timeline import Timeline


def gaps(timeline):
    return list(zip(timeline.gap_begins_s, timeline.gap_ends_s, strict=True))


def test_a_free_node_starts_at_once():
    assert Timeline(1.0).earliest_finish_s(3.0, 2.0) == 5.0


def test_a_task_fills_the_first_gap_that_holds_it():
    timeline = Timeline(1.0)
    timeline.book(2.0, 4.0)
    timeline.book(7.0, 9.0)

    assert timeline.earliest_finish_s(0.0, 2.0) == 2.0
    assert timeline.earliest_finish_s(1.0, 2.0) == 6.0
    assert timeline.earliest_finish_s(0.0, 4.0) == 13.0
    assert timeline.earliest_finish_s(20.0, 4.0) == 24.0


def test_booking_says_how_the_gaps_changed():
    timeline = Timeline(1.0)

    assert timeline.book(2.0, 4.0) == (0, 1, 2)
    assert gaps(timeline) == [(0.0, 2.0), (4.0, math.inf)]


def test_gaps_too_short_for_any_task_are_dropped():
    timeline = Timeline(1.0)

    assert timeline.book(0.5, 4.0) == (0, 1, 1)
    assert timeline.book(4.0, 5.0) == (0, 1, 1)
    assert gaps(timeline) == [(5.0, math.inf)]


def test_tasks_without_length_keep_gaps_without_length():
    timeline = Timeline(0.0)
    timeline.book(2.0, 2.0)
    timeline.book(2.0, 5.0)

    assert timeline.earliest_finish_s(1.0, 0.0) == 1.0
    assert timeline.earliest_finish_s(2.0, 0.0) == 2.0


def test_a_beginning_that_rounds_too_early_still_goes_behind_what_was_there():
    """Where SAGA stops with an error."""
    timeline = Timeline(0.0)
    timeline.book(0.3, 0.3)

    timeline.book(0.3 - 1e-16, 0.8)

    assert timeline.earliest_finish_s(0.3, 0.1) == 0.8 + 0.1


@settings(deadline=None)
@given(st.lists(st.tuples(st.floats(0, 20), st.floats(0.1, 3)), max_size=25))
def test_what_is_found_never_overlaps(requests):
    timeline, booked = Timeline(0.1), []
    for ready_s, duration_s in requests:
        finish_s = timeline.earliest_finish_s(ready_s, duration_s)
        booked.append((finish_s - duration_s, finish_s))
        timeline.book(*booked[-1])

        assert finish_s >= ready_s + duration_s
    booked.sort()
    assert all(a[1] <= b[0] + 1e-9 for a, b in pairwise(booked))
