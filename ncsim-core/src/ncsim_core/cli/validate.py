"""``ncsim validate``: is this scenario right?"""

import json
from typing import Annotated, Any

import typer

from ncsim_core.cli.choices import ScenarioPath, Settings, component_line, overrides_of
from ncsim_core.cli.exit_codes import ExitCode


def validate(
    scenarios: Annotated[list[str], typer.Argument(help="Scenario files.", metavar="SCENARIO...")],
    *,
    settings: Settings = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print faults as JSON.")] = False,
) -> None:
    """Check scenario files without running them; all faults of all files are shown.

    The models are built too, so that a link without bandwidth or a missing plug-in shows here.

    Example: ncsim validate examples/*.yaml
    """
    from ncsim_core.errors import NcsimError

    overrides = overrides_of(settings)
    answers: list[dict[str, Any]] = []
    for path in scenarios:
        try:
            answers.append(_answer(path, overrides))
        except NcsimError as error:
            answers.append({"file": path, "valid": False, "faults": _faults(error)})
            if not as_json:
                typer.echo(str(error), err=True)
        if not as_json and answers[-1]["valid"]:
            for note in answers[-1]["notes"]:
                typer.echo(f"{path}: note: {note}", err=True)
            typer.echo(f"{path}: ok, {answers[-1]['summary']}")
    if as_json:
        typer.echo(json.dumps(answers, indent=2))
    if not all(answer["valid"] for answer in answers):
        raise typer.Exit(ExitCode.INVALID_INPUT)


def _answer(path: ScenarioPath, overrides: dict[str, object]) -> dict[str, Any]:
    from ncsim_core.scenario.assembly import assemble
    from ncsim_core.scenario.loader import load_scenario

    scenario = load_scenario(path, overrides)
    assemble(scenario)
    tasks = sum(len(injection.dag.tasks) for injection in scenario.injections)
    summary = (
        f"{len(scenario.network.nodes)} nodes, {len(scenario.network.links)} links, "
        f"{len(scenario.injections)} DAGs, {tasks} tasks; {component_line(scenario.config)}"
    )
    return {"file": path, "valid": True, "summary": summary, "notes": list(scenario.notes)}


def _faults(error: Exception) -> object:
    to_json = getattr(error, "to_json", None)
    return to_json() if to_json else [{"message": str(error)}]
