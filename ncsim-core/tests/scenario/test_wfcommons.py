"""Workflows in the WfCommons format, read as DAGs; every mistake is told at its place."""

import json
from pathlib import Path

import pytest
from ncsim_core.scenario.faults import ScenarioFaults
from ncsim_core.scenario.wfcommons import read_workflow

ROOT = Path(__file__).parents[3]
FILM = ROOT / "examples" / "workflows" / "film_page.json"
MONTAGE = Path(__file__).parent / "data" / "montage-60.json"


def film(change, tmp_path):
    """Return the path of the film workflow after a change of its text."""
    text = change(FILM.read_text(encoding="utf-8"))
    path = tmp_path / "film.json"
    path.write_text(text, encoding="utf-8")
    return path


def faults_of(path):
    with pytest.raises(ScenarioFaults) as raised:
        read_workflow(path)
    return [(each.line, each.column, each.path, each.message) for each in raised.value.faults]


def test_montage_has_the_sizes_that_its_makers_state():
    found = read_workflow(MONTAGE)

    assert found.name == "montage-60"
    assert len(found.dag.tasks) == 58
    assert len(found.dag.dependencies) == 114
    sizes_MB = [each.data_size_MB for each in found.dag.dependencies]
    assert sum(sizes_MB) == pytest.approx(5343.588755)
    assert max(sizes_MB) == pytest.approx(414.72288)
    assert found.external_MB == pytest.approx(153.283055)
    assert sum(task.compute_cost for task in found.dag.tasks) == pytest.approx(1_857_253.4)


def test_a_dependency_carries_the_files_that_parent_and_child_share():
    dag = read_workflow(FILM).dag

    sizes_MB = {(each.source, each.target): each.data_size_MB for each in dag.dependencies}
    assert sizes_MB == {
        ("split", "cut_1"): 22.0,
        ("split", "cut_2"): 18.0,
        ("cut_1", "still_1"): 6.0,
        ("cut_2", "still_2"): 5.5,
        ("cut_1", "join"): 6.0,
        ("cut_2", "join"): 5.5,
        ("still_1", "join"): 0.25,
        ("still_2", "join"): 0.25,
    }


def test_run_times_become_costs_at_the_speed_given():
    tasks = read_workflow(FILM, units_per_s=50.0, dag_id="film").dag.tasks

    assert [task.compute_cost for task in tasks] == [200.0, 625.0, 550.0, 75.0, 75.0, 150.0]


def test_what_no_dependency_carries_is_counted():
    found = read_workflow(FILM)

    assert (found.external_MB, found.unread_MB) == (40.0, 12.0)


def test_a_parent_without_a_shared_file_is_a_dependency_of_no_bytes(tmp_path):
    path = film(lambda text: text.replace('"inputFiles": ["part_2"]', '"inputFiles": []'), tmp_path)

    dag = read_workflow(path).dag
    assert ("split", "cut_2", 0.0) in [
        (each.source, each.target, each.data_size_MB) for each in dag.dependencies
    ]


def test_a_file_makes_a_dependency_even_if_its_writer_is_not_named_as_parent(tmp_path):
    def forget(text):
        return text.replace('"parents": ["cut_1"]', '"parents": []').replace(
            '"children": ["still_1", "join"]', '"children": []'
        )

    dag = read_workflow(film(forget, tmp_path)).dag
    assert ("cut_1", "still_1", 6.0) in [
        (each.source, each.target, each.data_size_MB) for each in dag.dependencies
    ]


def test_names_that_are_nowhere_given_are_told_with_a_suggestion(tmp_path):
    path = film(
        lambda text: text.replace(
            '["split"], "children": ["still_1"', '["splt"], "children": ["still_1"'
        ),
        tmp_path,
    )

    with pytest.raises(ScenarioFaults, match="no task 'splt'; did you mean 'split'"):
        read_workflow(path)
    [(line, column, place, _)] = faults_of(path)
    assert (line, column, place) == (9, 54, "workflow.specification.tasks[1].parents[0]")


def test_all_faults_are_told_in_the_order_of_the_text(tmp_path):
    def spoil(text):
        return (
            text.replace('"id": "cut_2", "parents"', '"id": 2, "parents"')
            .replace('"sizeInBytes": 22000000', '"sizeInBytes": -1')
            .replace('"runtimeInSeconds": 12.5', '"runtimeInSeconds": "long"')
        )

    told = faults_of(film(spoil, tmp_path))
    assert [(line, message) for line, _, _, message in told] == [
        (10, "must be text, not 2; put it in quotes"),
        (17, "must be at least 0, not -1"),
        (31, "must be a number, not the text 'long'"),
    ]


def test_a_task_without_run_time_and_one_given_twice_are_told(tmp_path):
    def spoil(text):
        return text.replace(
            '{"id": "still_1", "runtimeInSeconds"', '{"id": "join", "runtimeInSeconds"'
        )

    messages = [message for _, _, _, message in faults_of(film(spoil, tmp_path))]
    assert messages == [
        "task 'still_1' has no run time in workflow.execution.tasks",
        "run time of task 'join' is given twice",
    ]


CYCLES = {
    "parent": ('"parents": []', '"parents": ["join"]', (8, "tasks[0].parents[0]")),
    "child": ('"children": []', '"children": ["split"]', (13, "tasks[5].children[0]")),
    "file": (
        '"inputFiles": ["film"]',
        '"inputFiles": ["film", "page"]',
        (8, "tasks[0].inputFiles[1]"),
    ),
}


@pytest.mark.parametrize("way", CYCLES)
def test_a_cycle_is_told_where_a_name_or_a_file_makes_it(way, tmp_path):
    before, after, expected = CYCLES[way]
    path = film(lambda text: text.replace(before, after, 1), tmp_path)

    [(line, _, place, message)] = faults_of(path)
    assert (line, place.removeprefix("workflow.specification.")) == expected
    assert message.startswith("the dependencies form a cycle: ")


def test_a_task_that_waits_for_itself_is_told_at_its_place(tmp_path):
    path = film(lambda text: text.replace('["split"]', '["cut_1"]', 1), tmp_path)

    [(line, _, _, message)] = faults_of(path)
    assert (line, message) == (9, "a task must not wait for itself")


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ('"id": "split"', '"id": "sp\\nlit"', "must be one line of plain text, not 'sp\\nlit'"),
        ('"film page"', '"film\\tpage"', "must be one line of plain text, not 'film\\tpage'"),
        ('"film page"', "7", "must be text, not 7; put it in quotes"),
        ('"sizeInBytes": 22000000', '"sizeInBytes": 1e101', "must be at most 1e+100, not 1e+101"),
        (
            '"runtimeInSeconds": 12.5',
            '"runtimeInSeconds": 1e99',
            "costs more than 1e+100 units at 100 units per second",
        ),
    ],
)
def test_what_no_scenario_may_hold_is_told_at_its_place(before, after, told, tmp_path):
    faults = faults_of(film(lambda text: text.replace(before, after, 1), tmp_path))

    assert told in [message for _, _, _, message in faults]
    assert all(line for line, _, _, _ in faults)


def test_files_that_make_a_million_dependencies_are_told_before_they_are_made(tmp_path):
    ids = [f"t{number}" for number in range(2001)]
    tasks = [{"id": each, "parents": [], "inputFiles": ["f"], "outputFiles": ["f"]} for each in ids]
    specification = {"tasks": tasks, "files": [{"id": "f", "sizeInBytes": 1}]}
    measured = [{"id": each, "runtimeInSeconds": 1} for each in ids]
    workflow = {"specification": specification, "execution": {"tasks": measured}}
    path = tmp_path / "many.json"
    path.write_text(json.dumps({"workflow": workflow}), encoding="utf-8")

    [(_, _, place, message)] = faults_of(path)
    assert place == "workflow.specification.tasks[499].inputFiles"
    assert message == "up to here, files make more than 1,000,000 dependencies"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "not valid JSON: Expecting value"),
        ("[]", "must be a mapping, not a list"),
        ("{}", "'workflow' is missing"),
        ('{"a": 1, "a": 2}', "key 'a' is given twice, first on line 1"),
        ("[" * 100_000, "nested too deep"),
        (
            '{"schemaVersion": "1.4", "workflow": {"tasks": []}}',
            "is of format 1.4; 1.5 and 1.6 are read (workflow.specification)",
        ),
    ],
    ids=["empty", "a list", "nothing", "twice", "deep", "old"],
)
def test_files_of_another_form_are_refused(text, told, tmp_path):
    path = tmp_path / "other.json"
    path.write_text(text, encoding="utf-8")

    assert [message for _, _, _, message in faults_of(path)] == [told]


def test_the_sample_is_json_as_others_write_it():
    assert json.loads(FILM.read_text(encoding="utf-8"))["schemaVersion"] == "1.6"
