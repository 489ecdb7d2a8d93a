"""``ncsim plugins``: what is installed, is it right, and a start for a new one."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ncsim_core.cli.exit_codes import ExitCode
from ncsim_core.errors import ScenarioError
from ncsim_core.plugins import KINDS

if TYPE_CHECKING:
    from ncsim_core.registry import PluginRecord, RegisteredComponent, RegisteredSection, Registry
    from ncsim_core.testing import CheckResult

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Look at installed plug-ins, check them, and start a new one.",
)

SECTION = "section"  # of config; shown as a component is
SHOWN = ("qualified_name", "version", "summary", "source", "factory", "capabilities")

AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@app.command("list")
def list_plugins(as_json: AsJson = False) -> None:
    """List plug-ins with their components, and why any of them cannot be used.

    Example: ncsim plugins list
    """
    from ncsim_core.registry import get_registry

    registry = get_registry()
    plugins = [_plugin_as_data(registry, record) for record in registry.plugins]
    if as_json:
        typer.echo(json.dumps({"plugins": plugins}, indent=2))
        return
    for plugin in plugins:
        typer.echo("\n".join(_plugin_lines(plugin)))


@app.command()
def show(kind: str, name: str, as_json: AsJson = False) -> None:
    """Show one component or config section: where it comes from, and a table of its options.

    KIND is a kind such as routing_model, its key in a scenario such as routing, or section.

    Example: ncsim plugins show scheduler round_robin
    """
    from ncsim_core.cli.option_table import option_table
    from ncsim_core.registry import get_registry

    registry = get_registry()
    if kind == SECTION:
        section = _section_named(registry, name)
        data, schema = _section_as_data(section), section.schema
    else:
        registered = registry.lookup(_kind_of(kind), name)
        data, schema = _component_as_data(registered), registry.options_schema(registered)
    if as_json:
        typer.echo(json.dumps(data | {"options": schema}, indent=2))
        return
    for label in SHOWN:
        if label in data:
            value = data[label]
            text = ", ".join(value) if isinstance(value, list) else str(value)
            typer.echo(f"{label.replace('_', ' ')}: {text or '-'}")
    for fault in _faults_of(data):
        typer.echo(f"cannot be used: {fault}")
    typer.echo("\n" + option_table(schema))


@app.command()
def check(
    distribution: Annotated[
        str | None, typer.Argument(help="Package to check; all of them if left out.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Run the conformance checks of installed plug-ins; a failure gives exit code 1.

    Example: ncsim plugins check ncsim-routing
    """
    from ncsim_core.cli.plugin_checks import (
        checked,
        counts,
        records_to_check,
        result_as_data,
        result_lines,
    )
    from ncsim_core.registry import get_registry

    registry = get_registry()
    records = records_to_check(registry, distribution)
    results: list[CheckResult] = []
    for record in records:
        for label, some in checked(registry, record):
            results += some
            if not as_json:
                typer.echo("\n".join(result_lines(label, some)))
    if as_json:
        typer.echo(json.dumps([result_as_data(each) for each in results], indent=2))
    else:
        typer.echo(f"in all: {counts(results)}")
    if any(each.is_bad for each in results):
        raise typer.Exit(ExitCode.INVALID_INPUT)


@app.command()
def new(
    name: Annotated[str, typer.Argument(help="Name of the package, such as ncsim-lookahead.")],
    kind: Annotated[
        str, typer.Option("--kind", help=f"What it is to be: {', '.join(KINDS)}.")
    ] = "scheduler",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder to write; by default ./NAME.")
    ] = None,
) -> None:
    """Write a small, complete plug-in project that installs and passes its tests.

    Example: ncsim plugins new ncsim-lookahead --kind scheduler
    """
    from ncsim_core.cli.plugin_project import write_project

    folder = output or Path(name)
    files = write_project(folder, name, _kind_of(kind))
    typer.echo(f"wrote {len(files)} files to {folder}; next:")
    typer.echo(f"  python -m pip install -e '{folder}[test]' && python -m pytest {folder}")


def _kind_of(text: str) -> str:
    """Return a kind from its name or from its key in a scenario.

    Raises:
        ScenarioError: It is neither.
    """
    by_key = {kind.config_key: kind.name for kind in KINDS.values()}
    found = by_key.get(text, text)
    if found not in KINDS:
        raise ScenarioError(f"unknown kind {text!r}; the kinds are {', '.join(KINDS)}")
    return found


def _section_named(registry: "Registry", name: str) -> "RegisteredSection":
    """Return a config section.

    Raises:
        ScenarioError: No plug-in brings it.
    """
    sections = {each.section.name: each for each in registry.sections()}
    if name not in sections:
        there_are = ", ".join(sections) or "none"
        raise ScenarioError(f"unknown config section {name!r}; there are: {there_are}")
    return sections[name]


def _section_as_data(registered: "RegisteredSection") -> dict[str, object]:
    return {
        "qualified_name": f"{registered.distribution}/{registered.section.name}",
        "version": registered.version,
        "summary": registered.section.summary,
    }


def _plugin_as_data(registry: "Registry", record: "PluginRecord") -> dict[str, object]:
    components = [
        _component_as_data(each)
        for kind in KINDS
        for each in registry.components(kind)
        if each.distribution == record.distribution and record.status == "ok"
    ]
    sections = [
        {"name": each.section.name, "summary": each.section.summary}
        for each in registry.sections()
        if each.distribution == record.distribution and record.status == "ok"
    ]
    return {
        "distribution": record.distribution,
        "version": record.version,
        "api": record.api,
        "status": record.status,
        "detail": record.detail,
        "components": components,
        "sections": sections,
    }


def _component_as_data(registered: "RegisteredComponent") -> dict[str, object]:
    from ncsim_core.registry.building import factory_fault

    component = registered.component
    return {
        "kind": component.kind,
        "name": component.name,
        "qualified_name": registered.qualified_name,
        "version": registered.version,
        "summary": component.summary,
        "source": component.source,
        "factory": component.factory,
        "capabilities": sorted(component.capabilities),
        "missing_requirements": list(registered.missing_requirements),
        "fault": factory_fault(registered) if registered.is_available else None,
    }


def _faults_of(component: dict[str, object]) -> Iterator[str]:
    missing = component.get("missing_requirements")
    if isinstance(missing, list):
        yield from (f"needs {each}" for each in missing)
    if component.get("fault"):
        yield str(component["fault"])


def _plugin_lines(plugin: dict[str, object]) -> Iterator[str]:
    detail = f": {plugin['detail']}" if plugin["detail"] else ""
    yield f"{plugin['distribution']} {plugin['version']}  {plugin['status']}{detail}"
    components = plugin["components"]
    for each in components if isinstance(components, list) else ():
        yield f"  {each['kind']:<18} {each['name']:<24} {each['summary']}"
        yield from (f"  {'':<18} {'':<24} cannot be used: {fault}" for fault in _faults_of(each))
    sections = plugin["sections"]
    for each in sections if isinstance(sections, list) else ():
        yield f"  {'config section':<18} {each['name']:<24} {each['summary']}"
