"""What to say when a name does not lead to one component."""

import difflib
from collections.abc import Iterable, Sequence

from ncsim_core.registry.records import PluginRecord, RegisteredComponent
from ncsim_core.registry.well_known import PROVIDER_BY_NAME, provider


def ambiguous_name(kind: str, name: str, rivals: Sequence[RegisteredComponent]) -> str:
    """Return the message for a bare name that several plug-ins offer."""
    forms = ", ".join(each.qualified_name for each in rivals)
    return f"{kind} {name!r} is offered by {len(rivals)} plug-ins; write one of: {forms}"


def unknown_name(
    kind: str, name: str, installed: Sequence[str], plugins: Sequence[PluginRecord]
) -> str:
    """Return the message for a name that nobody offers: what was meant, what to do."""
    return "; ".join(
        (
            f"unknown {kind} {name!r}",
            *_suggestion(kind, name, installed, plugins),
            f"installed: {', '.join(sorted(installed)) or 'none'}",
            *_plugins_left_out(plugins),
        )
    )


def close_match(name: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate that was probably meant: letters swapped, or nearly the same.

    >>> close_match("hetf", ["etf", "heft", "cpop"]), close_match("HEFT", ["heft"])
    ('heft', 'heft')
    """
    known = sorted(candidates)
    letters = sorted(name.casefold())
    swapped = [each for each in known if sorted(each.casefold()) == letters]
    by_lower = {each.casefold(): each for each in known}
    near = difflib.get_close_matches(name, known, n=1) or [
        by_lower[each] for each in difflib.get_close_matches(name.casefold(), by_lower, n=1)
    ]
    return next(iter([*swapped, *near]), None)


def _suggestion(
    kind: str, name: str, installed: Sequence[str], plugins: Sequence[PluginRecord]
) -> list[str]:
    """Return which name was meant and, where it is not there, which package has it."""
    loaded = {each.distribution for each in plugins if each.status == "ok"}
    known = {each for each, owner in PROVIDER_BY_NAME.get(kind, {}).items() if owner not in loaded}
    meant = name if name in known else close_match(name, {*installed, *known})
    if meant is None:
        return []
    advice = [] if meant == name else [f"did you mean {meant!r}"]
    package = provider(kind, meant)
    if meant not in installed and package is not None:
        is_there = package in {each.distribution for each in plugins}
        remedy = ", which did not load" if is_there else f": pip install {package}"
        advice.append(f"{meant!r} comes with {package}{remedy}")
    return advice


def _plugins_left_out(plugins: Iterable[PluginRecord]) -> list[str]:
    left_out = [
        f"{each.distribution} {each.version} ({each.status}: {each.detail})"
        for each in plugins
        if each.status != "ok"
    ]
    return [f"plug-ins that did not load: {', '.join(left_out)}"] if left_out else []
