"""The queue against the plainest one there can be: a list that is searched."""

from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.engine.event_queue import EventQueue
from ncsim_core.engine.events import TASK_READY, TRANSFER_COMPLETE
from ncsim_core.units import NEVER_us

TIMES = st.integers(0, 12)
TRANSFERS = st.integers(0, 3)
STEPS = st.lists(
    st.one_of(
        st.tuples(st.just("push"), TIMES),
        st.tuples(st.just("push soon")),
        st.tuples(st.just("complete"), TIMES, TRANSFERS),
        st.tuples(st.just("pause"), TRANSFERS),
        st.tuples(st.just("pop")),
    ),
    max_size=60,
)


class Sending:
    """What the queue knows of a transfer."""

    def __init__(self, number):
        self.number = self.rank = number
        self.completes_us = self.entered_us = NEVER_us


@given(STEPS)
def test_events_come_in_the_order_of_a_list_that_is_searched(steps):
    transfers = {number: Sending(number) for number in range(4)}
    queue, now_us, tickets = EventQueue(transfers), 0, 0
    events, completions = [], {}  # (time, kind, place, number) | time by transfer
    for what, *values in [*steps, *[("pop",)] * 70]:
        if what.startswith("push"):
            at_us = now_us + sum(values)
            (queue.push if values else queue.push_soon)(at_us, TASK_READY, tickets)
            events.append((at_us, TASK_READY, tickets, tickets))
            tickets += 1
        elif what == "complete":
            after_us, number = values
            complete_at(now_us + after_us, transfers[number], queue)
            completions[number] = now_us + after_us
        elif what == "pause":
            complete_at(NEVER_us, transfers[values[0]], queue)
            completions.pop(values[0], None)
        else:
            expected = min(
                [*events, *((at, TRANSFER_COMPLETE, k, k) for k, at in completions.items())],
                default=None,
            )
            assert queue.pop() == expected
            if expected is not None:
                now_us = expected[0]
                if expected[1] == TRANSFER_COMPLETE:
                    del completions[expected[3]]
                else:
                    events.remove(expected)


def complete_at(at_us, transfer, queue):
    transfer.completes_us = at_us
    if at_us < transfer.entered_us:
        queue.enter(transfer)
