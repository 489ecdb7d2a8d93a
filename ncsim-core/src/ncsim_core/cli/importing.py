"""``ncsim import``: workflows of other tools."""

import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ncsim_core.errors import ScenarioError

if TYPE_CHECKING:
    from ncsim_core.scenario.model import Scenario
    from ncsim_core.workflow import Injection


def import_workflow(  # noqa: PLR0913 - one parameter per option
    workflow: Annotated[
        Path, typer.Argument(metavar="WORKFLOW", help="WfCommons file (format 1.5 or 1.6).")
    ],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="YAML or .json; else to stdout."),
    ] = None,
    into: Annotated[
        Path | None,
        typer.Option(metavar="SCENARIO", help="Take network and config from this scenario."),
    ] = None,
    *,
    keep: Annotated[
        bool, typer.Option("--keep", help="Keep the DAGs of that scenario beside it.")
    ] = False,
    at: Annotated[float, typer.Option(min=0, help="When it is injected (s).")] = 0.0,
    speed: Annotated[
        float,
        typer.Option(
            metavar="UNITS_PER_S", min=0, help="Compute units that one second of run time costs."
        ),
    ] = 100.0,
    dag_id: Annotated[
        str | None, typer.Option("--id", help="Id of the DAG; else the workflow's name.")
    ] = None,
) -> None:
    """Read a WfCommons workflow as a DAG: a list of dags, or a whole scenario with --into.

    Example: ncsim import montage.json --into examples/grid_4x4.yaml -o montage.yaml
    """
    from ncsim_core.scenario.wfcommons import read_workflow
    from ncsim_core.units import us_from_s
    from ncsim_core.workflow import Injection

    if output is not None and output.exists():
        raise ScenarioError(f"{output}: exists already; choose another name")
    _check_options(at, speed, dag_id)
    if workflow.suffix.lower() in (".yaml", ".yml"):
        raise ScenarioError(
            f"{workflow}: a WfCommons workflow is JSON; scenarios, those of the published ncsim "
            f"too, need no import: ncsim run {workflow}"
        )
    found = read_workflow(workflow, units_per_s=speed, dag_id=dag_id)
    document = _document(Injection(us_from_s(at), found.dag), into, keep=keep)
    _write(document, output)
    size_MB = sum(each.data_size_MB for each in found.dag.dependencies)
    typer.echo(
        f"{found.name}: {len(found.dag.tasks)} tasks, {len(found.dag.dependencies)} dependencies, "
        f"{size_MB:.6g} MB between tasks\n"
        f"not carried: {found.external_MB:.6g} MB that no task writes, "
        f"{found.unread_MB:.6g} MB that no task reads",
        err=True,
    )


def _check_options(at: float, speed: float, dag_id: str | None) -> None:
    from ncsim_core.scenario.schema import ID_PATTERN, MAX_INJECT_AT_s
    from ncsim_core.units import is_quantity

    if not 0 <= at <= MAX_INJECT_AT_s:
        raise ScenarioError(f"--at {at}: must be from 0 to {MAX_INJECT_AT_s} seconds")
    if not is_quantity(speed):
        raise ScenarioError(f"--speed {speed}: must be a finite number of units per second")
    if dag_id is not None and not re.search(ID_PATTERN, dag_id):
        raise ScenarioError(f"--id {dag_id!r}: must be one line of plain text, not empty")


def _document(injection: "Injection", into: Path | None, *, keep: bool) -> dict[str, object]:
    from ncsim_core.scenario.loader import load_scenario
    from ncsim_core.scenario.model import dag_row

    if into is not None:
        return _merged(load_scenario(into), injection, keep=keep).to_document()
    if keep:
        raise ScenarioError("--keep needs --into SCENARIO")
    return {"dags": [dag_row(injection)]}


def _merged(scenario: "Scenario", injection: "Injection", *, keep: bool) -> "Scenario":
    """Return a scenario with another DAG, checked anew: its scheduler may need pins."""
    from ncsim_core.scenario.loader import parse_scenario
    from ncsim_core.scenario.model import ComponentSpec

    kept = scenario.injections if keep else ()
    components = scenario.config.components
    if kept and components["dag_source"].name == "single":
        components = {**components, "dag_source": ComponentSpec("multi")}
    merged = replace(
        scenario,
        name=scenario.name if keep else str(injection.dag.id),
        injections=(*kept, injection),
        config=replace(scenario.config, components=components),
    )
    return parse_scenario(merged.to_document(), name="--into")


def _write(document: dict[str, object], output: Path | None) -> None:
    from ncsim_core.scenario.yaml_text import dump_yaml
    from ncsim_core.trace.files import json_text, write_atomically

    is_json = output is not None and output.suffix.lower() == ".json"
    text = json_text(document) if is_json else dump_yaml(document)
    if output is None:
        typer.echo(text, nl=False)
    else:
        write_atomically(output, text)
