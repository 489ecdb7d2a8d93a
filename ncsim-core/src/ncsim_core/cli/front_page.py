"""What ``ncsim --help`` prints, made without the parser: half of the time would be its import.

A test holds this page and the one that typer would print equal.
"""

import textwrap
from collections.abc import Iterable
from importlib.metadata import EntryPoint, entry_points
from typing import Final, NamedTuple

COMMAND_GROUP: Final = "ncsim.commands"
"""Entry points by which packages bring verbs."""

PURPOSE: Final = (
    "Simulate DAG workflows on networked compute nodes whose wireless links slow each other down."
)
EXAMPLE: Final = "Example: ncsim run scenario.yaml -o out/"
EXIT_CODES: Final = "Exit codes: 0 ok, 1 invalid input, 2 a run did not complete, 3 internal error."
VERSION_HELP: Final = "Print the version and exit."

WIDTH: Final = 78


class Verb(NamedTuple):
    """A verb before it is imported.

    Args:
        location: ``"module:function"``, or ``"module:app"`` for a verb that has verbs of its own.
        summary: One line, short enough to stand beside the name.
    """

    location: str
    summary: str


VERBS: Final = {
    "run": Verb("ncsim_core.cli.run:run", "Run a scenario; with -o, leave trace and metrics."),
    "validate": Verb("ncsim_core.cli.validate:validate", "Check scenario files without running."),
    "new": Verb("ncsim_core.cli.new:new", "Write a small commented scenario to start from."),
    "explain": Verb("ncsim_core.cli.explain:explain", "Say where the time of a run went."),
    "compare": Verb("ncsim_core.cli.compare:compare", "Compare two runs, task by task."),
    "reproduce": Verb("ncsim_core.cli.reproduce:reproduce", "Run a folder's scenario again."),
    "sweep": Verb("ncsim_core.cli.sweep:sweep", "Run all combinations of a sweep file."),
    "report": Verb("ncsim_core.cli.report:report", "Print a table of a study."),
    "plot": Verb("ncsim_core.cli.plot:plot", "Draw a figure of a study."),
    "trace": Verb("ncsim_core.cli.trace:app", "Show the trace of a run, or verify it."),
    "import": Verb("ncsim_core.cli.importing:import_workflow", "Read a workflow of WfCommons."),
    "export": Verb("ncsim_core.cli.export:export", "Write a run in another form."),
    "plugins": Verb("ncsim_core.cli.plugins:app", "Look at plug-ins, check them, start one."),
    "doctor": Verb("ncsim_core.cli.doctor:doctor", "Say whether this installation is in order."),
    "schema": Verb("ncsim_core.cli.schema:schema", "Print the JSON Schema of a file format."),
}


def plugin_verbs() -> dict[str, EntryPoint]:
    """Return the verbs that packages bring, by name; a name of ncsim's own stays ncsim's."""
    found = sorted(entry_points(group=COMMAND_GROUP), key=lambda each: each.name)
    return {each.name: each for each in found if each.name not in VERBS}


def summaries() -> dict[str, str]:
    """Return one line about every verb, in the order in which they are listed."""
    own = {name: verb.summary for name, verb in VERBS.items()}
    return own | {name: f"Given by {_package(each)}." for name, each in plugin_verbs().items()}


def front_page() -> str:
    """Return the text of ``ncsim --help``."""
    sections = [
        "Usage: ncsim [OPTIONS] COMMAND [ARGS]...",
        _indented(PURPOSE),
        _indented(EXAMPLE),
        "Options:\n"
        + _columns([("--version", VERSION_HELP), ("--help", "Show this message and exit.")]),
        "Commands:\n" + _columns(summaries().items()),
        _indented(EXIT_CODES),
    ]
    return "\n\n".join(sections)


def _indented(text: str) -> str:
    return textwrap.fill(text, WIDTH, initial_indent="  ", subsequent_indent="  ")


def _columns(rows: Iterable[tuple[str, str]]) -> str:
    listed = list(rows)
    width = max(len(name) for name, _ in listed) + 2
    return "\n".join(f"  {name:{width}}{summary}" for name, summary in listed)


def _package(entry_point: EntryPoint) -> str:
    return entry_point.dist.name if entry_point.dist else "a plug-in"
