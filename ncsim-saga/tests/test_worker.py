"""The child process with hash seed 0: exact, honest about failures, replaced when it dies."""

import io
import json
import os
import subprocess
import sys

import pytest
from ncsim_core.errors import PlacementError
from ncsim_core.testing.builders import (
    chain,
    dag_of,
    diamond,
    line,
    make_context,
    make_snapshot,
    network_of,
)
from ncsim_saga import worker
from ncsim_saga.planning import PlanRequest, plan_with_saga
from ncsim_saga.schedulers.saga_scheduler import SagaScheduler
from ncsim_saga.virtual_network import virtual_network

NETWORK = virtual_network(make_snapshot(line(3, capacities=(80.0, 100.0, 150.0))))


@pytest.fixture(autouse=True, scope="module")
def no_child_left():
    yield
    worker.stop()


def test_the_child_plans_as_we_do_where_seeds_do_not_matter():
    request = PlanRequest("heft", NETWORK, diamond(cost=1 / 3))

    assert worker.plan_in_child(request) == plan_with_saga(request)


def test_one_child_serves_many_plans():
    worker.plan_in_child(PlanRequest("etf", NETWORK, diamond()))
    first = worker._worker

    worker.plan_in_child(PlanRequest("bil", NETWORK, diamond()))

    assert worker._worker is first


def test_a_plan_that_fails_is_an_error_here_and_the_child_lives_on():
    with pytest.raises(PlacementError, match=r"wba .* gave up"):
        worker.plan_in_child(PlanRequest("wba", NETWORK, diamond(), {"alpha": "half"}))

    assert worker.plan_in_child(PlanRequest("etf", NETWORK, diamond()))


def test_a_child_that_dies_is_reported_and_replaced():
    worker.plan_in_child(PlanRequest("etf", NETWORK, diamond()))
    worker._worker._process.kill()

    with pytest.raises(PlacementError, match="ended with code -9"):
        worker.plan_in_child(PlanRequest("etf", NETWORK, diamond()))

    assert worker.plan_in_child(PlanRequest("etf", NETWORK, diamond()))


def test_a_crash_shows_its_last_lines():
    worker.plan_in_child(PlanRequest("etf", NETWORK, diamond()))

    with pytest.raises(PlacementError, match="JSONDecodeError"):
        worker._worker.ask("this is no request")


def test_serving_answers_line_by_line():
    answers = io.StringIO()
    request = PlanRequest("fastest_node", NETWORK, diamond())

    worker.serve([request.to_json()] * 2, answers)

    lines = answers.getvalue().splitlines()
    assert [json.loads(line) for line in lines] == [{"placement": plan_with_saga(request)}] * 2


def test_smt_answers_the_same_whatever_it_was_asked_before():
    network = network_of([None] * 3, [(0, 1), (0, 2), (1, 2)], capacities=[100.0, 100.0, 50.0])
    scheduler = SagaScheduler(make_context(network), name="smt")
    dags = [chain(2), dag_of([], tasks=2), chain(2)]

    first, _, again = (scheduler.schedule(dag, make_snapshot(network)) for dag in dags)

    assert first == again


def test_smt_answers_the_same_whenever_garbage_is_due():
    code = (
        "import gc, sys; gc.set_threshold(int(sys.argv[1]));"
        "from ncsim_saga.planning import PlanRequest, plan_with_saga;"
        "print(plan_with_saga(PlanRequest.from_json(sys.stdin.read())))"
    )
    network = network_of([None] * 3, [(0, 1), (0, 2), (1, 2)], capacities=[100.0, 100.0, 50.0])
    request = PlanRequest("smt", virtual_network(make_snapshot(network)), chain(2)).to_json()

    plans = {
        subprocess.run(
            [sys.executable, "-c", code, threshold],
            input=request, capture_output=True, text=True, check=True,
            env=os.environ | {"PYTHONHASHSEED": "0"},
        ).stdout
        for threshold in ("300", "700", "100000")
    }  # fmt: skip

    assert len(plans) == 1
