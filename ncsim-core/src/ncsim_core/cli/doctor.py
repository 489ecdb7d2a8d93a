"""``ncsim doctor``: is this installation in order?"""

import json
import os
from typing import Annotated

import typer

from ncsim_core.cli.exit_codes import ExitCode


def doctor(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Print versions, plug-ins and problems, and run a self-test; trouble gives exit code 1.

    Example: ncsim doctor
    """
    from ncsim_core.cli.diagnosis import findings
    from ncsim_core.cli.tables import aligned

    found = list(findings())
    settings = {name: text for name, text in sorted(os.environ.items()) if name[:6] == "NCSIM_"}
    troubles = sum(each.state == "trouble" for each in found)
    if as_json:
        listed = [each._asdict() for each in found]
        document = {"ok": not troubles, "findings": listed, "environment": settings}
        typer.echo(json.dumps(document, indent=2))
    else:
        rows = [(each.state, each.what, each.text) for each in found]
        typer.echo(aligned(rows, ("state", "what", "found")))
        for name, text in settings.items():
            typer.echo(f"environment: {name}={text}")
        warnings = sum(each.state == "warning" for each in found)
        typer.echo(f"{len(found)} findings: {troubles} trouble, {warnings} warnings")
    if troubles:
        raise typer.Exit(ExitCode.INVALID_INPUT)
