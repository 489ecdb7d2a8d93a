"""``ncsim plugins``: list, show, check, new."""

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from ncsim_core.cli.plugins import app
from ncsim_core.errors import ScenarioError, UnknownComponentError
from ncsim_core.plugins import KINDS
from ncsim_core.testing.fixtures import DECLARATION, FakeDist, fake_dist, write_dist
from typer.testing import CliRunner, Result

__all__ = ["fake_dist"]

SCHEDULERS = """
from ncsim_core.builtin.schedulers import RoundRobinScheduler
from ncsim_core.workflow import PlacementPlan

class Forgetful(RoundRobinScheduler):
    def schedule(self, dag, snapshot):
        plan = super().schedule(dag, snapshot)
        return PlacementPlan(dict(list(plan.nodes.items())[1:]))
"""


FAILURES_OF_FORGETFUL = ("plan_is_total", "extremes_are_planned", "runs_obey_the_rules")


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, list(arguments))


def declaring(*components: str) -> str:
    listed = ", ".join(f"Component({each})" for each in components)
    return f"{DECLARATION}\n@hookimpl\ndef ncsim_components():\n    return [{listed}]\n"


def forgetful(fake_dist: FakeDist, extra: str = "") -> None:
    component = f'"scheduler", "forgetful", "forgetful_code:Forgetful", "Forgets."{extra}'
    fake_dist(
        "forgetful-dist",
        {"forgetful_declaration": declaring(component), "forgetful_code": SCHEDULERS},
    )


def test_list_shows_each_plugin_with_its_components():
    output = run("list").output

    assert "ncsim-core" in output
    assert "Deals unpinned tasks out to the nodes in turn" in output


def test_list_tells_why_a_plugin_or_component_cannot_be_used(fake_dist):
    fake_dist("bad-dist", {"bad_declaration": "1 / 0"})
    fake_dist(
        "half-dist",
        {
            "half_declaration": declaring(
                '"scheduler", "gone", "no_such_module:x", "Gone."',
                '"scheduler", "needy", "m:f", "Needy.", requires=("no-such-package>=3",)',
            )
        },
    )

    output = run("list").output

    assert "bad-dist 1.0  failed: ZeroDivisionError: division by zero" in output
    assert "cannot import no_such_module:x" in output
    assert "needs no-such-package>=3 (not installed)" in output


def test_list_as_json_has_kinds_names_and_status():
    plugins = json.loads(run("list", "--json").output)["plugins"]

    core = plugins[0]
    assert (core["distribution"], core["status"]) == ("ncsim-core", "ok")
    assert {each["kind"] for each in core["components"]} == set(KINDS)


def test_show_prints_a_table_of_options(fake_dist):
    schema = """{"type": "object", "additionalProperties": False, "required": ["must"],
        "properties": {
            "depth": {"type": "integer", "minimum": 1, "default": 2, "description": "Levels."},
            "mode": {"enum": ["a", "b"], "default": "a", "description": "How."},
            "must": {"type": "number", "exclusiveMaximum": 5, "description": "In s."}}}"""
    component = f'"scheduler", "mine", "m:f", "One line.", {schema}, source="Eq. 3"'
    fake_dist("mine-dist", {"mine_declaration": declaring(component)})

    lines = run("show", "scheduler", "mine").output.splitlines()

    assert "qualified name: mine-dist/mine" in lines
    assert "source: Eq. 3" in lines
    table = [line.split() for line in lines[lines.index("") + 1 :]]
    assert table == [
        ["option", "type", "default", "bounds", "description"],
        ["depth", "integer", "2", ">=", "1", "Levels."],
        ["mode", "a", "|", "b", '"a"', "-", "How."],
        ["must", "number", "required", "<", "5", "In", "s."],
    ]


def test_show_takes_the_key_of_a_scenario_for_a_kind():
    assert "no options" in run("show", "routing", "direct").output


def test_show_of_a_config_section_prints_its_keys(fake_dist):
    gain = {"type": "number", "minimum": 0, "default": 0, "description": "In dB."}
    schema = {"type": "object", "additionalProperties": False, "properties": {"gain_dB": gain}}
    section = f'Section(name="antenna", summary="All antennas.", schema={schema})'
    declaration = f"{DECLARATION}\n@hookimpl\ndef ncsim_sections():\n    return [{section}]\n"
    fake_dist("antenna-dist", {"antenna_declaration": declaration})

    lines = run("show", "section", "antenna").output.splitlines()

    assert lines[0] == "qualified name: antenna-dist/antenna"
    assert "summary: All antennas." in lines
    assert lines[-1].split() == ["gain_dB", "number", "0", ">=", "0", "In", "dB."]
    assert "there are: " in str(run("show", "section", "aerial").exception)


def test_show_of_an_unknown_name_or_kind_says_what_there_is():
    assert isinstance(run("show", "scheduler", "manuel").exception, UnknownComponentError)
    assert isinstance(run("show", "planner", "manual").exception, ScenarioError)


def test_check_of_a_good_plugin_passes_and_counts(fake_dist):
    component = '"queue_model", "mine", "ncsim_core.builtin.queue_models:FifoQueue", "Fifo."'
    fake_dist("mine-dist", {"mine_declaration": declaring(component)})

    result = run("check", "mine-dist")

    assert result.exit_code == 0, result.output
    assert result.output.splitlines() == [
        "mine-dist 1.0: 4 run, 0 skipped, 0 expected failures, 0 failed",
        "queue_model mine-dist/mine: 14 run, 1 skipped, 0 expected failures, 0 failed",
        "    skipped: declared_order_is_kept: does not declare order",
        "in all: 18 run, 1 skipped, 0 expected failures, 0 failed",
    ]


def test_check_fails_on_a_component_that_breaks_its_contract(fake_dist):
    forgetful(fake_dist)

    result = run("check", "Forgetful_Dist")

    assert result.exit_code == 1
    assert "failed: plan_is_total: missing {'T0'}" in result.output


def test_check_counts_declared_expected_failures(fake_dist):
    reasons = dict.fromkeys(FAILURES_OF_FORGETFUL, "by design")
    forgetful(fake_dist, f", expected_failures={reasons}")

    result = run("check", "forgetful-dist", "--json")

    outcomes = {each["check"]: each["status"] for each in json.loads(result.output)}
    assert result.exit_code == 0
    assert outcomes["plan_is_total"] == "expected_failure"
    assert outcomes["planned_nodes_exist"] == "passed"
    assert outcomes["scaling_changes_nothing"] == "skipped"


def test_check_fails_on_an_expected_failure_that_passes(fake_dist):
    reasons = dict.fromkeys([*FAILURES_OF_FORGETFUL, "planned_nodes_exist"], "by design")
    forgetful(fake_dist, f", expected_failures={reasons}")

    result = run("check", "forgetful-dist")

    assert result.exit_code == 1
    assert "unexpected pass: planned_nodes_exist" in result.output


def test_check_of_a_plugin_that_does_not_load_fails_with_the_reason(fake_dist):
    fake_dist("bad-dist", {"bad_declaration": "1 / 0"})

    result = run("check", "bad-dist")

    assert result.exit_code == 1
    assert "failed: loads: failed: ZeroDivisionError" in result.output


def test_check_says_once_what_keeps_a_component_from_answering_at_all(fake_dist):
    component = '"scheduler", "broken", "broken_code:Broken", "Breaks."'
    code = SCHEDULERS.replace("Forgetful", "Broken").replace("plan = super()", "plan = 1 / 0  #")
    fake_dist("broken-dist", {"broken_declaration": declaring(component), "broken_code": code})

    lines = run("check", "broken-dist").output.splitlines()

    failed = [line for line in lines if line.lstrip().startswith("failed:")]
    assert len(failed) == 1, lines
    assert "runs_obey_the_rules, equal_runs_leave_equal_traces" in failed[0]
    assert (
        "it answers nothing: ZeroDivisionError: division by zero (broken_code.py, line 7)"
        in (failed[0])
    )
    assert len(lines) < 20


def test_check_names_the_option_that_the_class_does_not_take(fake_dist):
    options = (
        "options={'type': 'object', 'additionalProperties': False, 'properties': "
        "{'spread': {'type': 'integer', 'default': 1, 'description': 'How many.'}}}"
    )
    forgetful(fake_dist, f", {options}")

    output = run("check", "forgetful-dist").output

    assert "factory_takes_every_option: forgetful_code:Forgetful must take a context" in output
    assert "declared options (spread)" in output


def test_check_of_a_package_without_entry_point_says_what_is_missing():
    error = run("check", "pytest").exception

    assert "is installed, but offers no entry point in the group 'ncsim.plugins'" in str(error)
    assert "did you mean 'ncsim-core'" in str(run("check", "ncsim-cor").exception)


@pytest.mark.parametrize("name", ["import", "3x", "two words"])
def test_a_name_that_no_package_can_have_is_refused(name, tmp_path):
    assert "cannot be a package name" in str(run("new", name, "-o", str(tmp_path / "x")).exception)


@pytest.mark.parametrize("kind", KINDS)
def test_new_project_passes_its_own_tests(kind, tmp_path):
    name = f"ncsim-made-{kind.replace('_', '-')}"
    project = tmp_path / name

    assert run("new", name, "--kind", kind, "--output", str(project)).exit_code == 0

    done = in_child(project, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(project))
    assert done.returncode == 0, done.stdout + done.stderr
    assert " passed" in done.stdout


def in_child(project: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run Python where the project looks installed."""
    points = tomllib.loads((project / "pyproject.toml").read_text())["project"]["entry-points"]
    site = project.parent / "site"
    write_dist(site, project.name, {}, entry_points=points["ncsim.plugins"])
    path = os.pathsep.join([str(project / "src"), str(site)])
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=project,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.slow
def test_new_project_installs_with_pip_and_is_found(tmp_path):
    run("new", "ncsim-made", "--output", str(tmp_path / "made"))
    python = str(tmp_path / "venv" / "bin" / "python")
    own = [each for each in sys.path if each.endswith("site-packages")]
    core = str(Path(__file__).parents[2] / "src")

    subprocess.run([sys.executable, "-m", "venv", str(tmp_path / "venv")], check=True)
    install = ["-m", "pip", "install", "-q", "--no-deps", "-e", str(tmp_path / "made")]
    subprocess.run([python, *install], check=True)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([core, *own])}
    done = subprocess.run(
        [python, "-m", "pytest", "-q", str(tmp_path / "made")],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )

    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("name", ["Upper", "1st", "a--b", "a b", "../up"])
def test_new_refuses_what_cannot_be_a_package_name(name, tmp_path):
    result = run("new", name, "--output", str(tmp_path / "x"))

    assert isinstance(result.exception, ScenarioError)
    assert not (tmp_path / "x").exists()


def test_new_overwrites_nothing(tmp_path):
    (tmp_path / "precious").write_text("text")

    assert isinstance(run("new", "mine", "-o", str(tmp_path)).exception, ScenarioError)
