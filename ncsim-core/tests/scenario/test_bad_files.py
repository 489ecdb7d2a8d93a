"""One bad file per case: each fault is found at its line and column, with words that help."""

from pathlib import Path

import pytest
from ncsim_core.registry import Registry
from ncsim_core.scenario import ScenarioFaults, load_scenario, parse_scenario

HERE = Path(__file__).parent
BAD_FILES = sorted((HERE / "bad").iterdir())


def expected_faults() -> dict[str, list[str]]:
    """Return the beginnings of the expected faults, by file name."""
    expected: dict[str, list[str]] = {}
    for line in (HERE / "expected_faults.txt").read_text("utf-8").splitlines():
        if not line.startswith("#"):
            expected.setdefault(line.partition(":")[0], []).append(line)
    return expected


@pytest.mark.parametrize("path", BAD_FILES, ids=lambda path: path.stem)
def test_each_bad_file_gives_exactly_the_expected_faults(path, with_antenna: Registry):
    with pytest.raises(ScenarioFaults) as caught:
        load_scenario(path, registry=with_antenna)

    found = [fault.render().replace(f"{path.parent}/", "") for fault in caught.value.faults]
    expected = expected_faults()[path.name]
    assert len(found) == len(expected), found
    for text, beginning in zip(found, expected, strict=True):
        assert text.startswith(beginning)


def test_every_bad_file_has_an_expectation():
    assert {path.name for path in BAD_FILES} == set(expected_faults())


@pytest.mark.parametrize(
    ("name", "suggestion"),
    [
        ("unknown_key", "network"),
        ("unknown_key_in_row", "compute_cost"),
        ("unknown_config_key", "seed"),
        ("dangling_link_end", "n1"),
        ("unknown_radio_option", "gain_dB"),
        ("unknown_choice", "wired"),
        ("misspelt_root", "scenario"),
        ("single_source_for_two", "multi"),
    ],
)
def test_near_words_are_suggested(name, suggestion, with_antenna: Registry):
    with pytest.raises(ScenarioFaults) as caught:
        load_scenario(HERE / "bad" / f"{name}.yaml", registry=with_antenna)

    assert caught.value.faults[0].suggestion == suggestion
    assert f"did you mean '{suggestion}'?" in str(caught.value)


def test_an_unknown_component_is_explained_by_the_registry(core: Registry):
    with pytest.raises(
        ScenarioFaults, match=r"did you mean 'round_robin'.*installed: all_on_fastest, manual"
    ):
        load_scenario(HERE / "bad" / "unknown_component.yaml", registry=core)


def test_the_caret_stands_below_the_offending_word(core: Registry):
    with pytest.raises(ScenarioFaults) as caught:
        load_scenario(HERE / "bad" / "dangling_link_end.yaml", registry=core)

    _, source, carets = str(caught.value).splitlines()
    assert source[carets.index("^") : carets.rindex("^") + 1] == "n11"


def test_a_missing_file_is_named_with_its_neighbour(core: Registry, tmp_path):
    (tmp_path / "grid.yaml").write_text("scenario: {}")

    with pytest.raises(ScenarioFaults, match=r"gird.yaml  no such file; did you mean .*grid.yaml"):
        load_scenario(tmp_path / "gird.yaml", registry=core)


def test_a_directory_is_no_scenario(core: Registry, tmp_path):
    with pytest.raises(ScenarioFaults, match="is a directory, not a scenario file"):
        load_scenario(tmp_path, registry=core)


def test_a_file_that_cannot_be_read_says_why(core: Registry, tmp_path):
    (tmp_path / "file").write_text("x")

    with pytest.raises(ScenarioFaults, match="cannot be read: Not a directory"):
        load_scenario(tmp_path / "file" / "scenario.yaml", registry=core)


def test_a_faulty_file_of_ten_thousand_rows_is_reported_in_part(core: Registry):
    rows = ", ".join(f"{{id: T{i}}}" for i in range(10_000))
    text = (
        "scenario: {network: {nodes: [{id: n, compute_capacity: 1}]}, "
        f"dags: [{{id: d, tasks: [{rows}]}}]}}"
    )

    with pytest.raises(ScenarioFaults) as caught:
        parse_scenario(text, registry=core)

    assert len(caught.value.faults) == 1001
    assert "only the first 1000 were looked at" in str(caught.value)
    assert "... and 951 more faults" in str(caught.value)
