"""The verbs of ``ncsim`` as typer runs them, each imported when it is used and not before."""

from importlib import import_module
from importlib.metadata import EntryPoint
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup
from typing_extensions import override

from ncsim_core.cli.exit_codes import Interrupted
from ncsim_core.cli.front_page import (
    EXAMPLE,
    EXIT_CODES,
    PURPOSE,
    VERBS,
    VERSION_HELP,
    plugin_verbs,
    summaries,
)
from ncsim_core.errors import PluginError
from ncsim_core.registry.well_known import PROVIDER_OF_VERB

PLAIN: dict[str, Any] = {
    "rich_markup_mode": None,
    "add_completion": False,
    "pretty_exceptions_enable": False,
}
"""Settings of every ``typer.Typer`` here: plain help, so that rich stays unimported."""


class VerbGroup(TyperGroup):
    """Lists all verbs by name and summary; imports the one that is used."""

    def __init__(self, **settings: Any) -> None:  # noqa: ANN401 - whatever typer passes
        super().__init__(**settings)
        for name, summary in summaries().items():
            self.add_command(TyperCommand(name, help=summary, rich_markup_mode=None))

    @override
    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:  # typer would leave with 130 and say nothing
            raise Interrupted from None

    @override
    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
        owner = None if args[0] in self.commands else PROVIDER_OF_VERB.get(args[0])
        if owner is not None:
            raise PluginError(f"ncsim {args[0]} comes with {owner}: pip install {owner}")
        name, _, rest = super().resolve_command(ctx, args)
        if name is None:
            return name, None, rest
        command = verb_command(name) if name in VERBS else _forwarding(plugin_verbs()[name])
        return name, command, rest


def verb_command(name: str) -> Any:  # noqa: ANN401 - typer gives its command classes no public name
    """Return one of ncsim's own verbs as typer runs it."""
    module, _, attribute = VERBS[name].location.partition(":")
    found = getattr(import_module(module), attribute)
    if isinstance(found, typer.Typer):
        return typer.main.get_group(found)
    app = typer.Typer(**PLAIN)
    app.command(name)(found)
    return typer.main.get_command(app)


def _forwarding(entry_point: EntryPoint) -> Any:  # noqa: ANN401 - as above
    """Return a command that hands all arguments to a plug-in's own app."""
    app = typer.Typer(**PLAIN)

    @app.command(
        entry_point.name,
        add_help_option=False,
        context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
    )
    def forward(context: typer.Context) -> object:
        command = entry_point.load()
        prog_name = f"ncsim {entry_point.name}"
        return command(args=context.args, prog_name=prog_name, standalone_mode=False)

    return typer.main.get_command(app)


app = typer.Typer(
    name="ncsim", cls=VerbGroup, help=f"{PURPOSE}\n\n{EXAMPLE}", epilog=EXIT_CODES, **PLAIN
)


@app.callback()
def _options(
    version: Annotated[bool, typer.Option("--version", help=VERSION_HELP)] = False,
) -> None:
    """Describe what ``main`` answers without the parser."""
