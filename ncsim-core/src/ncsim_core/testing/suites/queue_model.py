"""Properties of queue models."""

from collections.abc import Mapping
from typing import cast

import pytest
from hypothesis.stateful import run_state_machine_as_test
from hypothesis.strategies import SearchStrategy
from typing_extensions import override

from ncsim_core.contracts.queue_model import QueueModel
from ncsim_core.testing import strategies
from ncsim_core.testing.builders import line
from ncsim_core.testing.checking import check, steady_settings
from ncsim_core.testing.machines import ORDER_KEYS, queue_machine
from ncsim_core.testing.questions import Case
from ncsim_core.testing.subject import Subject
from ncsim_core.testing.suites.base import ComponentSuite


class QueueModelSuite(ComponentSuite):
    """Checks of a queue model."""

    kind = "queue_model"

    @override
    def cases(self) -> SearchStrategy[Case]:
        return strategies.waiting_lines()

    @override
    def strategies(self) -> Mapping[str, SearchStrategy[object]]:
        crowded = strategies.runs(max_nodes=2, max_tasks=8)
        return {**super().strategies(), "run": crowded}

    @check(is_drawn=False)
    def check_nothing_is_lost_or_invented(self, subject: Subject) -> None:
        """Whatever is pushed is popped once, and ``len()`` tells how many wait."""
        machine = queue_machine(lambda: _queue(subject), None)
        run_state_machine_as_test(machine, settings=steady_settings(self.examples))

    @check(capability="order", is_drawn=False)
    def check_declared_order_is_kept(self, subject: Subject) -> None:
        """Tasks are popped in the order that ``order=`` declares."""
        order = subject.capability("order")
        assert order in ORDER_KEYS, f"unknown order {order!r}; known: {', '.join(ORDER_KEYS)}"
        machine = queue_machine(lambda: _queue(subject), order)
        run_state_machine_as_test(machine, settings=steady_settings(self.examples))

    @check()
    def check_pop_of_nothing_is_an_index_error(self, subject: Subject, case: Case) -> None:
        """An empty queue says so by ``IndexError``, whatever went before."""
        queue = _queue(subject)
        subject.ask(queue, case)
        with pytest.raises(IndexError):
            queue.pop()

    @check()
    def check_queues_do_not_meet(self, subject: Subject, case: Case) -> None:
        """The queues of two nodes share nothing."""
        first, second = _queue(subject), _queue(subject)
        for task in case.waiting:
            if task is not None:
                first.push(task)
        assert len(second) == 0, f"a push to another queue gave it {len(second)} tasks"


def _queue(subject: Subject) -> QueueModel:
    return cast("QueueModel", subject.build(Case(line(1))))
