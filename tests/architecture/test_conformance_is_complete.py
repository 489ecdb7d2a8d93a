"""Every component of the five packages has its conformance class."""

import ast
from pathlib import Path

import pytest
from ncsim_core.plugins import KINDS
from ncsim_core.registry import get_registry

ROOT = Path(__file__).parents[2]
PACKAGES = {"ncsim-core", "ncsim-routing", "ncsim-saga", "ncsim-viz", "ncsim-wifi"}


def first_party():
    return [
        (each.distribution, kind, each.component.name)
        for kind in KINDS
        for each in get_registry().components(kind)
        if each.distribution in PACKAGES and each.is_available
    ]


def claimed(package):
    """Return (contract, component) for each suite that stands in a package's tests."""
    return {
        (suite.removesuffix("Suite"), statement.value.value)
        for path in (ROOT / package / "tests").rglob("test_*.py")
        for suite, body in suites(ast.parse(path.read_text(encoding="utf-8")))
        for statement in body
        if isinstance(statement, ast.Assign) and statement.targets[0].id == "component"
    }


def suites(module):
    for each in module.body:
        if isinstance(each, ast.ClassDef):
            for base in each.bases:
                if isinstance(base, ast.Name) and base.id.endswith("Suite"):
                    yield base.id, each.body


@pytest.mark.parametrize(("package", "kind", "name"), first_party())
def test_component_has_a_conformance_class(package, kind, name):
    suite = KINDS[kind].contract.rpartition(":")[2]

    assert (suite, name) in claimed(package)


def test_there_are_components_to_look_at():
    assert len(first_party()) >= 35
