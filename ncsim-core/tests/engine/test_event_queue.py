"""The queue against the plainest one there can be: a list that is searched."""

from hypothesis import given
from hypothesis import strategies as st
from ncsim_core.engine.event_queue import EventQueue
from ncsim_core.engine.events import TASK_READY, TRANSFER_COMPLETE

TIMES = st.integers(0, 12)
TRANSFERS = st.integers(0, 3)
STEPS = st.lists(
    st.one_of(
        st.tuples(st.just("push"), TIMES),
        st.tuples(st.just("complete"), TIMES, TRANSFERS),
        st.tuples(st.just("pause"), TRANSFERS),
        st.tuples(st.just("pop")),
    ),
    max_size=60,
)


@given(STEPS)
def test_events_come_in_the_order_of_a_list_that_is_searched(steps):
    queue, now_us, tickets = EventQueue(), 0, 0
    events, completions = [], {}  # (time, kind, rank, ticket) | time by transfer
    for what, *values in [*steps, *[("pop",)] * 70]:
        if what == "push":
            tickets += 1
            queue.push(now_us + values[0], TASK_READY, tickets)
            events.append((now_us + values[0], TASK_READY, 0, tickets))
        elif what == "complete":
            after_us, transfer = values
            queue.complete_at(now_us + after_us, transfer, rank=transfer)
            completions[transfer] = now_us + after_us
        elif what == "pause":
            queue.pause(values[0])
            completions.pop(values[0], None)
        else:
            expected = min(
                [*events, *((at, TRANSFER_COMPLETE, k, k) for k, at in completions.items())],
                default=None,
            )
            due = queue.pop()
            assert (due and (due[0], due[1], due[4])) == (
                expected and (expected[0], expected[1], expected[3])
            )
            if expected is not None:
                now_us = expected[0]
                if expected[1] == TRANSFER_COMPLETE:
                    del completions[expected[3]]
                else:
                    events.remove(expected)
