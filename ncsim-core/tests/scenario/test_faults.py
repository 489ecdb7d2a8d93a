import pytest
from ncsim_core.scenario import Fault, ScenarioFaults
from ncsim_core.scenario.faults import shown
from ncsim_core.scenario.loader import parse_scenario


def test_a_fault_without_a_line_is_one_line_of_text():
    fault = Fault("config.seed", None, None, "is wrong", origin="override seed='x'")

    assert fault.render() == "override seed='x'  config.seed: is wrong"


def test_a_long_line_is_cut_around_the_fault():
    line = "x" * 500 + "BAD" + "y" * 500
    fault = Fault("a", 1, 501, "is wrong", origin="f.yaml", line_text=line, length=3)

    _, source, carets = fault.render().splitlines()
    assert len(source) < 120
    assert source[carets.index("^") : carets.rindex("^") + 1] == "BAD"


def test_control_characters_do_not_reach_the_terminal():
    fault = Fault("a", 1, 1, "is wrong", origin="f.yaml", line_text="\x1b[31mred\tand more")

    assert "\x1b" not in fault.render()


def test_faults_become_plain_data():
    fault = Fault("a.b", 3, 4, "is wrong", "'5'", "5", origin="f.yaml", line_text="b: '5'")

    assert ScenarioFaults([fault]).to_json() == [
        {
            "path": "a.b",
            "line": 3,
            "column": 4,
            "message": "is wrong",
            "value": "'5'",
            "suggestion": "5",
            "origin": "f.yaml",
            "pointer": "",
        }
    ]


def test_a_fault_points_into_the_document_as_it_was_written():
    published = {"network": {"nodes": []}, "dags": []}  # without its root

    with pytest.raises(ScenarioFaults) as caught:
        parse_scenario(published)

    pointers = {each.path: each.pointer for each in caught.value.faults}
    assert pointers["network.nodes"] == "/network/nodes"


@pytest.mark.parametrize(
    ("value", "text"),
    [(None, "nothing"), ({}, "a mapping"), ([], "a list"), (True, "true"), (5, "5"), ("5", "'5'")],
)
def test_values_are_shown_as_the_user_knows_them(value, text):
    assert shown(value) == text


def test_long_values_are_cut():
    assert len(shown("x" * 1000)) == 60
