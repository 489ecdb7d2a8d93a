"""Properties of a plug-in as a whole."""

import importlib.metadata
from collections.abc import Callable
from typing import ClassVar

import pytest
from typing_extensions import override

from ncsim_core.plugins import KINDS, PLUGIN_GROUP
from ncsim_core.registry import RegisteredComponent, Registry, get_registry
from ncsim_core.registry.building import factory_fault
from ncsim_core.registry.records import normalised
from ncsim_core.testing.checking import described
from ncsim_core.testing.child import run_python
from ncsim_core.testing.results import CheckResult

HEAVY = ("numpy", "networkx", "scipy", "pandas", "saga", "torch", "jsonschema", "hypothesis")
"""What importing a declaration module must not import."""


class PluginSuite:
    """Checks of one installed distribution; subclass it and set ``distribution``."""

    distribution: ClassVar[str] = ""

    @override
    def __init_subclass__(cls) -> None:
        """Turn the checks into tests of this subclass."""
        for name, body in CHECKS.items():
            setattr(cls, f"test_{name}", _test_of(body))


def plugin_results(distribution: str, registry: Registry | None = None) -> list[CheckResult]:
    """Return what comes of all checks of one distribution; it raises nothing."""
    results = []
    for name, body in CHECKS.items():
        try:
            body(registry or get_registry(), distribution)
        except (Exception, SystemExit) as error:
            results.append(CheckResult(distribution, name, "failed", described(error), error=error))
        else:
            results.append(CheckResult(distribution, name, "passed"))
    return results


def loads(registry: Registry, distribution: str) -> None:
    """The plug-in loads and declares an API that fits."""
    records = [each for each in registry.plugins if each.distribution == distribution]
    assert records, f"{distribution} has no entry point in {PLUGIN_GROUP}, or is not installed"
    for each in records:
        assert each.status == "ok", f"{each.status}: {each.detail}"


def declaration_stays_light(registry: Registry, distribution: str) -> None:
    """Importing the declaration module imports none of the big libraries."""
    broken = any(each.is_broken for each in registry.plugins if each.distribution == distribution)
    for module in () if broken else _declaration_modules(distribution):  # loads() says why
        code = f"import sys, {module}; print([m for m in {HEAVY} if m in sys.modules])"
        done = run_python(["-c", code], b"", {})
        assert done.returncode == 0, done.stderr.decode()[-2000:]
        heavy = done.stdout.decode().strip()
        assert heavy == "[]", f"importing {module} imports {heavy}"


def factories_can_be_imported(registry: Registry, distribution: str) -> None:
    """Every factory exists; a class is one of its contract."""
    for each in components_of(registry, distribution):
        fault = factory_fault(each) if each.is_available else None
        assert fault is None, fault


def every_component_has_a_summary(registry: Registry, distribution: str) -> None:
    """``ncsim plugins list`` has a line to show for each component."""
    for each in components_of(registry, distribution):
        assert each.component.summary.strip(), f"{each.qualified_name} has no summary"


def components_of(registry: Registry, distribution: str) -> list[RegisteredComponent]:
    """Return the components of one distribution, kind by kind."""
    return [
        each
        for kind in KINDS
        for each in registry.components(kind)
        if each.distribution == distribution
    ]


CHECKS: dict[str, Callable[[Registry, str], None]] = {
    body.__name__: body
    for body in (
        loads,
        declaration_stays_light,
        factories_can_be_imported,
        every_component_has_a_summary,
    )
}


def _test_of(body: Callable[[Registry, str], None]) -> Callable[[PluginSuite], None]:
    def test(self: PluginSuite) -> None:
        if not self.distribution:
            pytest.fail("set distribution to the name of your package")
        body(get_registry(), self.distribution)

    test.__doc__ = body.__doc__
    return test


def _declaration_modules(distribution: str) -> list[str]:
    return sorted(
        each.module
        for each in importlib.metadata.entry_points(group=PLUGIN_GROUP)
        if each.dist is not None and normalised(each.dist.name) == distribution
    )
