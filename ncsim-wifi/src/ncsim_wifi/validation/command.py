"""``ncsim validate-model``: does the radio model still do what the paper says?"""

import json
from collections import Counter
from collections.abc import Iterable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from ncsim_wifi.validation.rows import Row, Verdict

EXIT_FAILED = 2
VERDICTS: "tuple[Verdict, ...]" = ("pass", "FAIL", "differs")
ABOUT_DIFFERENCES = (
    "differs: packets do something else than the model. Rows from the paper check that the model\n"
    "errs as the paper says; docs/wifi-model.md says what that means for using it."
)

app = typer.Typer(rich_markup_mode=None, add_completion=False, pretty_exceptions_enable=False)


class StageName(StrEnum):
    """The three stages of validation."""

    INTERNAL = "internal"
    LITERATURE = "literature"
    PACKET = "packet"


@app.command()
def validate_model(
    stage: Annotated[
        list[StageName] | None, typer.Option(help="Run this stage only; may be repeated.")
    ] = None,
    as_json: Annotated[  # noqa: FBT002 - typer declares flags this way
        bool, typer.Option("--json", help="Print rows as JSON.")
    ] = False,
    details: Annotated[  # noqa: FBT002 - typer declares flags this way
        bool, typer.Option("--details", help="Print every link of the large packet studies, too.")
    ] = False,
    plots: Annotated[
        Path | None, typer.Option(help="Write the figures into this folder (needs matplotlib).")
    ] = None,
) -> None:
    """Compare the radio model with its definitions, with Bianchi (2000) and with ns-3.

    Prints expected and measured, error and verdict row by row. "differs" marks a comparison with
    packets, in which the model is known to err; that it errs as the paper states is judged in
    rows of its own. Takes a few seconds. Exits with 2 if a row fails.

    Example: ncsim validate-model --stage literature --plots figures/
    """
    chosen = list(dict.fromkeys(stage or StageName))
    rows = [row for each in chosen for row in rows_of(each)]
    if as_json:
        typer.echo(json.dumps([row.to_dict() for row in rows], indent=2))
    else:
        _print_tables(chosen, rows, has_details=details)
    if plots is not None:
        _write_figures(plots)
    if any(row.verdict == "FAIL" for row in rows):
        raise typer.Exit(EXIT_FAILED)


def rows_of(stage: StageName) -> "Iterable[Row]":
    """Return the comparisons of a stage."""
    from ncsim_wifi.validation import internal, literature, packet

    match stage:
        case StageName.INTERNAL:
            return internal.rows()
        case StageName.LITERATURE:
            return literature.rows()
        case StageName.PACKET:
            return packet.rows()


def _print_tables(stages: "Iterable[StageName]", rows: "list[Row]", *, has_details: bool) -> None:
    from ncsim_wifi.validation.rows import table_text

    for number, stage in enumerate(stages):
        of_stage = [row for row in rows if row.stage == stage]
        shown = [row for row in of_stage if has_details or not _is_left_out(row)]
        typer.echo(("\n" if number else "") + f"== {stage} ==")
        typer.echo(table_text(shown))
        typer.echo(_summary(of_stage, len(of_stage) - len(shown)))


def _is_left_out(row: "Row") -> bool:
    """Return whether a row is told with ``--details`` only; none that fails is."""
    return row.is_detail and row.verdict != "FAIL"


def _summary(rows: "list[Row]", left_out: int) -> str:
    """Return how many comparisons a stage has and what they came to."""
    counts = Counter(row.verdict for row in rows)
    told = ", ".join(f"{counts[each]} {each}" for each in VERDICTS if counts[each])
    more = f"; --details shows {left_out} more" if left_out else ""
    about = "\n" + ABOUT_DIFFERENCES if counts["differs"] else ""
    return f"{len(rows)} comparisons: {told}{more}{about}"


def _write_figures(folder: Path) -> None:
    try:
        from ncsim_wifi.validation.figures import write_figures
    except ImportError as error:
        typer.echo(f"--plots needs matplotlib ({error}): pip install 'ncsim-wifi[plots]'", err=True)
        raise typer.Exit(1) from None
    for path in write_figures(folder):
        typer.echo(f"wrote {path}", err=True)
