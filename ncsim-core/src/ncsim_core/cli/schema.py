"""``ncsim schema``: the JSON Schemas of the file formats, for editors and scripts."""

import json
from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class SchemaKind(StrEnum):
    """A file format with a schema."""

    SCENARIO = "scenario"
    SWEEP = "sweep"
    TRACE = "trace"
    METRICS = "metrics"


def schema(
    *,
    kind: Annotated[
        SchemaKind | None,
        typer.Option(help="Which format; scenario if left out, or all of them with --write."),
    ] = None,
    write: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write KIND.schema.json files here.")
    ] = None,
) -> None:
    """Print the JSON Schema of a file format, options of all installed plug-ins included.

    Example: ncsim schema --kind scenario > scenario.schema.json
    """
    if write is None:
        typer.echo(schema_text(kind or SchemaKind.SCENARIO), nl=False)
        return
    from ncsim_core.trace.files import write_atomically

    write.mkdir(parents=True, exist_ok=True)
    for each in [kind] if kind else SchemaKind:
        path = write / f"{each}.schema.json"
        write_atomically(path, schema_text(each))
        typer.echo(f"wrote {path}", err=True)


def schema_text(kind: SchemaKind) -> str:
    """Return a schema as JSON text that ends in a newline."""
    return json.dumps(_composed(kind), indent=2, ensure_ascii=False) + "\n"


def _composed(kind: SchemaKind) -> Mapping[str, object]:
    match kind:
        case SchemaKind.SCENARIO:
            from ncsim_core.registry import get_registry
            from ncsim_core.scenario.schema import compose_schema

            return compose_schema(get_registry())
        case SchemaKind.SWEEP:
            from ncsim_core.registry import get_registry
            from ncsim_core.sweep.schema import sweep_schema

            return sweep_schema(get_registry())
        case SchemaKind.METRICS:
            from ncsim_core.metrics.schema import metrics_schema

            return metrics_schema()
        case SchemaKind.TRACE:
            from ncsim_core.trace.schema import trace_schema

            return trace_schema()
