"""The code and the options in ``docs/wifi-model.md`` are those of the package."""

import re
from pathlib import Path

import pytest
from ncsim_core.testing.builders import make_context
from ncsim_wifi.schemas import rf_schema
from ncsim_wifi.validation.scenes import parallel

PAGE = (Path(__file__).parents[2] / "docs/wifi-model.md").read_text("utf-8")


def test_the_model_to_plug_in_runs_as_it_stands():
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    names = {}
    exec(code, names)
    model = names["EqualTurnsModel"](make_context(parallel(3, 60.0).network()))

    assert model.factors([0, 1, 2], [0, 1, 2]).tolist() == pytest.approx([1 / 2, 1 / 3, 1 / 2])
    assert model.factors([0], [0]).tolist() == [1.0]
    assert {0, 1} <= set(model.reach([0]))


def test_every_key_of_rf_is_in_the_table_with_its_default_and_range():
    for name, schema in rf_schema()["properties"].items():
        (row,) = re.findall(rf"^\| `{name}` \| (.*) \| (.*) \| .* \|$", PAGE, re.MULTILINE)
        (default, bounds), stated = row, schema["default"]

        assert default.split()[0] == (
            f"{stated:g}" if type(stated) in (int, float) else str(stated).lower()
        )
        if "minimum" in schema:
            assert bounds == f"{schema['minimum']:g} to {schema['maximum']:g}"


def test_every_rule_that_the_code_cites_is_on_the_page_of_rules():
    root = Path(__file__).parents[2]
    rules = re.findall(r"^(\d+)\. ", (root / "docs/spec.md").read_text("utf-8"), re.MULTILINE)
    sources = [path.read_text("utf-8") for path in root.glob("ncsim-*/src/**/*.py")]

    cited = {number for text in sources for number in re.findall(r"SPEC (\d+)", text)}

    assert rules == [str(number) for number in range(1, 24)]
    assert cited <= set(rules)
    assert len(cited) > 10
