"""Options that several verbs share: which scenario values to override, and when to give up."""

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from ncsim_core.errors import ScenarioError

if TYPE_CHECKING:
    from ncsim_core.engine.setup import Limits
    from ncsim_core.scenario.model import Config

ScenarioPath: TypeAlias = Annotated[
    str, typer.Argument(help="Scenario file, YAML or JSON.", metavar="SCENARIO")
]
Settings: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        "-s",
        metavar="KEY=VALUE",
        help="Override a value under config, e.g. -s rf.tx_power_dBm=18. May be repeated.",
    ),
]
SchedulerName: TypeAlias = Annotated[
    str | None, typer.Option("--scheduler", help="Override config.scheduler.", metavar="NAME")
]
RoutingName: TypeAlias = Annotated[
    str | None, typer.Option("--routing", help="Override config.routing.", metavar="NAME")
]
InterferenceName: TypeAlias = Annotated[
    str | None, typer.Option("--interference", help="Override config.interference.", metavar="NAME")
]
Seed: TypeAlias = Annotated[int | None, typer.Option("--seed", help="Override config.seed.")]
MaxEvents: TypeAlias = Annotated[
    int | None, typer.Option("--max-events", min=0, help="Give up after this many events.")
]
MaxTime: TypeAlias = Annotated[
    float | None,
    typer.Option("--max-time", min=0, help="Give up when simulated time passes this (s)."),
]

MaxWall: TypeAlias = Annotated[
    float | None,
    typer.Option("--max-wall", min=0, help="Give up after this many seconds on the clock."),
]
MaxMemory: TypeAlias = Annotated[
    float | None,
    typer.Option("--max-memory", min=0, help="Give up when the run takes more MB than this."),
]


def overrides_of(settings: Sequence[str] | None, **named: object) -> dict[str, object]:
    """Return overrides by dotted path: those of ``--set``, then the named options given.

    Raises:
        ScenarioError: A setting has no ``=``.
    """
    overrides: dict[str, object] = {}
    for setting in settings or ():
        key, equals, text = setting.partition("=")
        if not equals or not key.strip():
            raise ScenarioError(
                f"--set {setting!r}: expected KEY=VALUE, e.g. --set rf.tx_power_dBm=18"
            )
        overrides[key.strip()] = _value(text)
    return overrides | {key: value for key, value in named.items() if value is not None}


def refuse_endless(**limits: float | None) -> None:
    """Raise if a limit of an option is infinite or not a number.

    Args:
        **limits: By the option's name, as Python spells it.

    Raises:
        ScenarioError: One is.
    """
    for name, value in limits.items():
        if value is not None and not math.isfinite(value):
            option = f"--{name.replace('_', '-')}"
            raise ScenarioError(f"{option} {value}: must be finite; leave it out for no limit")


def limits_of(max_events: int | None, max_time_s: float | None) -> "Limits":
    """Return the limits of a run."""
    from ncsim_core.engine.setup import Limits
    from ncsim_core.units import us_from_s

    return Limits(max_events, None if max_time_s is None else us_from_s(max_time_s))


def _value(text: str) -> object:
    """Return what a scenario file would make of ``text``; lists and mappings as JSON."""
    from ncsim_core.scenario.yaml_text import plain_value

    word = text.strip()
    if not word.startswith(("[", "{")):
        return plain_value(word)
    try:
        return json.loads(word)
    except ValueError as error:
        raise ScenarioError(f"--set: {word!r} is no JSON: {error}") from None


def component_line(config: "Config") -> str:
    """Return which components answer, in one line."""
    from ncsim_core.plugins import KINDS

    return ", ".join(
        f"{KINDS[kind].config_key} {spec.name}" for kind, spec in config.components.items()
    )
