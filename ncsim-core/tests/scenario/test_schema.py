import json
import re
from pathlib import Path

import jsonschema
import pytest
from ncsim_core.cli.schema import SchemaKind, schema, schema_text
from ncsim_core.registry import Registry, get_registry
from ncsim_core.scenario.schema import compose_schema

SCHEMAS = Path(__file__).parents[3] / "schemas"
FIRST_PARTY = ("ncsim-core", "ncsim-wifi", "ncsim-saga", "ncsim-routing", "ncsim-viz")


@pytest.fixture
def first_party(monkeypatch):
    """Let the process's registry hold the packages of this repository only."""
    monkeypatch.setenv("NCSIM_PLUGINS", ",".join(FIRST_PARTY))
    get_registry.cache_clear()
    yield
    get_registry.cache_clear()


def properties_below(node, path=""):
    """Yield every property schema with its path."""
    if isinstance(node, dict):
        for name, child in node.get("properties", {}).items():
            if isinstance(child, dict):
                yield f"{path}.{name}", child
        for key, child in node.items():
            yield from properties_below(child, f"{path}.{key}")
    elif isinstance(node, list):
        for index, child in enumerate(node):
            yield from properties_below(child, f"{path}[{index}]")


def test_the_composed_schema_is_a_valid_draft_07_schema(with_antenna: Registry):
    jsonschema.Draft7Validator.check_schema(compose_schema(with_antenna))


def test_every_property_has_a_description(core: Registry):
    lacking = [
        path
        for path, child in properties_below(compose_schema(core))
        if "description" not in child and ".if." not in path and ".then" not in path
    ]

    assert lacking == []


@pytest.mark.parametrize(
    ("key", "unit"),
    [
        ("bandwidth", "MB/s"),
        ("latency", "s"),
        ("data_size", "MB"),
        ("inject_at", "s"),
        ("x", "m"),
        ("y", "m"),
        ("position", "m"),
        ("compute_cost", "[Uu]nits"),
        ("compute_capacity", "units per second"),
    ],
)
def test_every_quantity_states_its_unit(core: Registry, key, unit):
    texts = [
        child["description"]
        for path, child in properties_below(compose_schema(core))
        if path.endswith(f".{key}")
    ]

    assert texts
    assert all(re.search(rf"\b{unit}\b", text) for text in texts)


def test_options_and_sections_of_plug_ins_are_part_of_it(with_antenna: Registry):
    text = json.dumps(compose_schema(with_antenna))

    assert '"gain_dB"' in text
    assert '"noise_dBm"' in text


def test_a_wrong_option_gives_one_flat_error_for_any_validator(with_antenna: Registry):
    document = {
        "scenario": {
            "network": {"nodes": [{"id": "n", "compute_capacity": 1}]},
            "dags": [{"id": "d", "tasks": [{"id": "t", "compute_cost": 1}]}],
            "config": {"link_model": {"type": "antenna", "options": {"gain_dB": 99}}},
        }
    }
    validator = jsonschema.Draft7Validator(compose_schema(with_antenna))

    (error,) = validator.iter_errors(document)
    deepest = [list(each.absolute_path) for each in error.context or ()]
    assert ["scenario", "config", "link_model", "options", "gain_dB"] in deepest


@pytest.mark.parametrize("kind", SchemaKind)
def test_the_published_schemas_are_up_to_date(kind, first_party):
    published = (SCHEMAS / f"{kind}.schema.json").read_text("utf-8")

    assert published == schema_text(kind), (
        f"run: NCSIM_PLUGINS={','.join(FIRST_PARTY)} ncsim schema --write schemas"
    )


def test_schema_prints_one_format_and_writes_all(capsys, tmp_path, first_party):
    schema(kind=SchemaKind.SCENARIO)
    schema(write=tmp_path / "new")

    printed = capsys.readouterr().out
    files = {path.name: path.read_text("utf-8") for path in (tmp_path / "new").iterdir()}
    assert files["scenario.schema.json"] == printed
    assert set(files) == {f"{kind}.schema.json" for kind in SchemaKind}
