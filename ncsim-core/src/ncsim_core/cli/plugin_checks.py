"""What ``ncsim plugins check`` asks of each package, and how it tells what came of it."""

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from ncsim_core.errors import PluginError, some_of

if TYPE_CHECKING:
    from ncsim_core.registry import PluginRecord, Registry
    from ncsim_core.testing import CheckResult

MOST_NAMED: Final = 3
"""Checks that fail for one reason are named up to here; ``--json`` has them all."""


def records_to_check(registry: "Registry", distribution: str | None) -> list["PluginRecord"]:
    """Return the plug-ins of a distribution, or all that are not disabled.

    Raises:
        PluginError: The distribution is not installed, or is no plug-in.
    """
    from ncsim_core.registry.records import normalised

    if distribution is None:
        return [each for each in registry.plugins if each.status != "disabled"]
    wanted = normalised(distribution)
    found = [each for each in registry.plugins if each.distribution == wanted]
    if not found:
        raise PluginError(
            _not_a_plugin(distribution, [each.distribution for each in registry.plugins])
        )
    return found


def _not_a_plugin(distribution: str, plugins: Sequence[str]) -> str:
    from importlib.metadata import PackageNotFoundError, version

    from ncsim_core.plugins import PLUGIN_GROUP
    from ncsim_core.registry.messages import close_match

    try:
        there = f"{distribution} {version(distribution)} is installed"
    except PackageNotFoundError:
        meant = close_match(distribution, plugins)
        hint = f"did you mean {meant!r}? " if meant else ""
        return f"no plug-in package {distribution!r}; {hint}installed: {', '.join(plugins)}"
    return (
        f"{there}, but offers no entry point in the group {PLUGIN_GROUP!r}; add one to its "
        "pyproject.toml and install it again"
    )


def checked(
    registry: "Registry", record: "PluginRecord"
) -> Iterator[tuple[str, list["CheckResult"]]]:
    """Yield a label and the results of a plug-in as a whole, then of each component.

    Raises:
        PluginError: The extra that brings the checks is not installed.
    """
    try:
        from ncsim_core.testing import CheckResult, check_component
        from ncsim_core.testing.suites.plugin import components_of, plugin_results
    except ModuleNotFoundError as error:
        raise PluginError(f"checks need {error.name}: pip install 'ncsim-core[testing]'") from error
    yield f"{record.distribution} {record.version}", plugin_results(record.distribution, registry)
    if record.status != "ok":
        return
    for each in components_of(registry, record.distribution):
        label = f"{each.component.kind} {each.qualified_name}"
        if each.is_available:
            yield (
                label,
                check_component(each.component.kind, each.qualified_name, registry=registry),
            )
        else:
            needs = f"needs {', '.join(each.missing_requirements)}"
            yield label, [CheckResult(each.qualified_name, "is_available", "skipped", needs)]


def result_lines(label: str, results: Sequence["CheckResult"]) -> Iterator[str]:
    """Yield what came of the checks of one component; what is alike is told once."""
    yield f"{label}: {counts(results)}"
    alike: dict[tuple[str, str], list[str]] = {}
    for each in results:
        if each.status != "passed":
            alike.setdefault((each.status, each.detail), []).append(each.check)
    for (status, detail), checks in alike.items():
        indented = detail.replace("\n", "\n      ")
        names = some_of(checks, MOST_NAMED)
        yield f"    {status.replace('_', ' ')}: {names}: {indented}"


def counts(results: Sequence["CheckResult"]) -> str:
    """Return for example ``12 run, 1 skipped, 0 expected failures, 0 failed``."""
    by_status = Counter(each.status for each in results)
    bad = sum(each.is_bad for each in results)
    return (
        f"{len(results) - by_status['skipped']} run, {by_status['skipped']} skipped, "
        f"{by_status['expected_failure']} expected failures, {bad} failed"
    )


def result_as_data(result: "CheckResult") -> dict[str, object]:
    """Return a result as JSON has it."""
    return {
        "component": result.component,
        "check": result.check,
        "status": result.status,
        "detail": result.detail,
        "duration_s": round(result.duration_s, 6),
    }
