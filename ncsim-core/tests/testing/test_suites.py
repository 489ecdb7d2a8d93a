"""The kit is tested too: every check catches the component planted for it."""

import subprocess
import sys
from pathlib import Path

import pytest
from ncsim_core.errors import UnknownComponentError
from ncsim_core.plugins import KINDS
from ncsim_core.registry import get_registry
from ncsim_core.testing import check_component
from ncsim_core.testing.fixtures import DECLARATION, fake_dist
from ncsim_core.testing.suites import SUITES, SchedulerSuite
from ncsim_core.testing.suites.plugin import CHECKS, plugin_results

__all__ = ["fake_dist"]

PLANTED = Path(__file__).parent / "planted"

NUMBER_OF_CHECKS = {
    "scheduler": 15,
    "routing_model": 18,
    "link_model": 14,
    "interference_model": 29,
    "queue_model": 15,
    "dag_source": 14,
}

ALL_CHECKS = [(kind, one.name) for kind, suite in SUITES.items() for one in suite.checks()]


def declaring(component: str) -> str:
    hook = f"@hookimpl\ndef ncsim_components():\n    return [Component({component})]\n"
    return DECLARATION + hook


@pytest.fixture
def planted(fake_dist, monkeypatch):
    monkeypatch.syspath_prepend(PLANTED)
    fake_dist("ncsim-planted", {}, entry_points={"planted": "ncsim_planted.declaration"})


def result_of(kind, component, check, **members):
    suite = type("PlantedSuite", (SUITES[kind],), {"component": component, **members})()
    return suite.result(next(one for one in suite.checks() if one.name == check))


@pytest.mark.parametrize("kind", KINDS)
def test_number_of_checks_per_kind_is_known(kind):
    assert len(SUITES[kind].checks()) == NUMBER_OF_CHECKS[kind]


@pytest.mark.parametrize(("kind", "check"), ALL_CHECKS)
def test_each_check_catches_the_component_planted_for_it(kind, check, planted):
    result = result_of(kind, f"ncsim-planted/{check}", check)

    assert result.status == "failed", result
    assert "it refused" not in result.detail
    assert not isinstance(result.error, UnknownComponentError)


def test_nothing_is_planted_for_no_check(planted):
    components = [
        (kind, each.component.name)
        for kind in KINDS
        for each in get_registry().components(kind)
        if each.distribution == "ncsim-planted"
    ]

    assert sorted(components) == sorted(ALL_CHECKS)


def test_a_good_model_of_routes_passes_every_check(fake_dist):
    code = (
        "from ncsim_core.testing.toys import ToyRelays\n"
        "def make(context):\n    return ToyRelays(context.network)\n"
    )
    declaration = declaring(
        '"interference_model", "relays", "relay_code:make", "Relays.",'
        ' capabilities=frozenset({"decides_routes"})'
    )
    fake_dist("relay-dist", {"relay_declaration": declaration, "relay_code": code})

    results = check_component("interference_model", "relays")
    assert [each for each in results if each.is_bad] == []
    assert {each.check for each in results if each.status == "skipped"} == {
        "one_more_link_never_helps"
    }


def test_failure_shows_a_small_falsifying_example(planted):
    result = result_of("scheduler", "planned_nodes_exist", "planned_nodes_exist")

    assert result.detail.startswith("no such nodes: {'n1'}"), result.detail
    assert "case: DAG dag: tasks T0 (100 units), T1 (100 units); edges none" in result.detail
    assert len(result.detail.splitlines()) < 8


def test_what_a_component_prints_does_not_disturb_its_checks(fake_dist):
    source = (
        "from ncsim_core.builtin.schedulers import RoundRobinScheduler\n"
        "class Chatty(RoundRobinScheduler):\n"
        "    def schedule(self, dag, snapshot):\n"
        "        print('thinking')\n        return super().schedule(dag, snapshot)\n"
    )
    declaration = declaring('"scheduler", "chatty", "chatty_code:Chatty", "Chats."')
    fake_dist("chatty-dist", {"chatty_declaration": declaration, "chatty_code": source})

    assert result_of("scheduler", "chatty", "hash_seed_changes_nothing").status == "passed"


def test_a_failure_in_pytest_is_told_without_the_insides_of_the_kit(planted):
    members = {"component": "ncsim-planted/planned_nodes_exist"}
    suite = type("PlantedSuite", (SchedulerSuite,), members)()

    with pytest.raises(pytest.fail.Exception) as failed:
        suite.test_planned_nodes_exist()

    told = failed.value.msg
    assert told.startswith("The plan names nodes of the network only.\nno such nodes: {'n1'}")
    assert not failed.value.pytrace


def test_an_error_in_a_plugin_keeps_its_place_under_hypothesis(fake_dist):
    source = (
        "from ncsim_core.builtin.schedulers import RoundRobinScheduler\n"
        "class Picky(RoundRobinScheduler):\n"
        "    def schedule(self, dag, snapshot):\n"
        "        return super().schedule(dag, snapshot) if len(dag.tasks) > 2 else 1 / 0\n"
    )
    declaration = declaring('"scheduler", "picky", "picky_code:Picky", "Picky."')
    fake_dist("picky-dist", {"picky_declaration": declaration, "picky_code": source})

    detail = result_of("scheduler", "picky", "plan_is_total").detail

    assert detail.startswith("ZeroDivisionError: division by zero (picky_code.py, line 4)")


def test_component_that_refuses_everything_is_no_success(fake_dist):
    source = (
        "from ncsim_core.errors import ScenarioError\n"
        "def make(context):\n    raise ScenarioError('not today')\n"
    )
    declaration = declaring('"scheduler", "lazy", "lazy_code:make", "Lazy."')
    fake_dist("lazy-dist", {"lazy_declaration": declaration, "lazy_code": source})

    checks = ("plan_is_total", "hash_seed_changes_nothing", "extremes_are_planned")
    results = [result_of("scheduler", "lazy", check, examples=2) for check in checks]

    assert [each.status for each in results] == ["failed"] * 3
    assert results[0].detail == "it refused every example that was tried"


def test_expected_failure_that_names_no_check_is_refused():
    with pytest.raises(ValueError, match=r"no checks \['plan_is_totl'\]"):
        type("Typo", (SchedulerSuite,), {"expected_failures": {"plan_is_totl": "typo"}})


def test_expected_failure_is_reported_with_its_reason(planted):
    reasons = {"plan_is_total": "known", "planned_nodes_exist": "wrong"}

    expected = result_of("scheduler", "plan_is_total", "plan_is_total", expected_failures=reasons)
    passing = result_of(
        "scheduler", "plan_is_total", "planned_nodes_exist", expected_failures=reasons
    )

    assert (expected.status, expected.detail, expected.is_bad) == (
        "expected_failure",
        "known",
        False,
    )
    assert (passing.status, passing.is_bad) == ("unexpected_pass", True)


def test_check_of_a_capability_not_declared_is_skipped_and_says_so():
    result = result_of("scheduler", "manual", "scaling_changes_nothing")

    assert (result.status, result.detail) == ("skipped", "does not declare scale_invariant")


def test_unknown_component_is_an_error_and_no_result():
    with pytest.raises(UnknownComponentError):
        check_component("scheduler", "no_such_scheduler")


def test_two_subclasses_share_no_test_function():
    first = type("First", (SchedulerSuite,), {"component": "manual"})
    second = type("Second", (SchedulerSuite,), {"component": "round_robin"})

    assert first.test_plan_is_total is not second.test_plan_is_total
    assert not hasattr(SchedulerSuite, "test_plan_is_total")


def test_results_are_the_same_each_time(planted):
    first, second = (result_of("scheduler", "plan_is_total", "plan_is_total") for _ in range(2))

    assert first.detail == second.detail


PLUGIN_FAULTS = {
    "loads": ("1 / 0", "ZeroDivisionError"),
    "declaration_stays_light": (f"import numpy\n{DECLARATION}", "numpy"),
    "factories_can_be_imported": (
        declaring('"scheduler", "gone", "no_such:x", "Gone."'),
        "cannot import no_such:x",
    ),
    "every_component_has_a_summary": (
        declaring('"scheduler", "bare", "m:f", ""'),
        "has no summary",
    ),
}


@pytest.mark.parametrize("check", CHECKS)
def test_each_check_of_a_plugin_catches_the_fault_planted_for_it(check, fake_dist):
    source, detail = PLUGIN_FAULTS[check]
    fake_dist("bad-dist", {"bad_declaration": source})

    results = {each.check: each for each in plugin_results("bad-dist")}

    assert results[check].status == "failed"
    assert detail in results[check].detail


def test_core_runs_without_the_extra_that_brings_the_checks():
    code = (
        "import sys; sys.modules['hypothesis'] = sys.modules['pytest'] = None;"
        "from ncsim_core.testing import builders, oracle;"
        "from typer.testing import CliRunner; from ncsim_core.cli.plugins import app;"
        "print(repr(CliRunner().invoke(app, ['check']).exception))"
    )

    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)

    assert "pip install 'ncsim-core[testing]'" in done.stdout, done.stdout + done.stderr
