"""What can go wrong, sorted by who can mend it.

How a run ends is not an error: see ``ncsim_core.engine.outcome.RunStatus``.
"""

import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import Final

OURS: Final = ("ncsim_core", "importlib", "pluggy", "hypothesis")
"""How the packages begin that call plug-ins: what they raise is not where one went wrong."""


class NcsimError(Exception):
    """Root of all errors that ncsim raises on purpose."""


class ScenarioError(NcsimError):
    """The user's input is wrong; the message says where and what to do."""


class PluginError(NcsimError):
    """A plug-in did not load, or answered with something it must not answer."""


class UnknownComponentError(PluginError, LookupError):
    """No installed plug-in offers a component of that kind and name."""


class PlacementError(PluginError):
    """A scheduler's plan lacks a task or names a node that does not exist."""


class ModelScopeError(NcsimError):
    """A model was asked for something it does not cover, such as a third interferer.

    A run in which this happens ends ``failed`` with this message; there is no silent
    switch to another model.
    """


class ConvergenceError(NcsimError):
    """A numerical solver did not reach its stated residual."""


class EngineError(NcsimError):
    """ncsim broke one of its own invariants: a bug, please report it."""


def some_of(texts: Sequence[str], most: int) -> str:
    """Return the first few texts in a row, and how many more there are.

    >>> some_of(["a", "b", "c"], 2)
    'a, b and 1 more'
    """
    more = f" and {len(texts) - most} more" if len(texts) > most else ""
    return ", ".join(texts[:most]) + more


def told(error: BaseException) -> str:
    """Return what a plug-in raised and, as far as its own code was reached, where.

    >>> told(ValueError("too small"))
    'ValueError: too small'
    """
    place = place_of(error)
    return f"{type(error).__name__}: {error}" + (f" ({place})" if place else "")


def place_of(error: BaseException) -> str | None:
    """Return file and line of the plug-in's own code that an error came through last, if any."""
    frames = [
        (str(frame.f_globals.get("__name__", "")), frame.f_code.co_filename, line)
        for frame, line in traceback.walk_tb(error.__traceback__)
    ]
    theirs = [each for each in frames if not _package(each[0]).startswith(OURS)]
    if not theirs:
        return None
    owner = _package(theirs[0][0])
    module, filename, line = [each for each in theirs if _package(each[0]) == owner][-1]
    folder = "".join(f"{each}/" for each in module.split(".")[:-1])
    return f"{folder}{Path(filename).name}, line {line}"


def _package(module: str) -> str:
    return module.partition(".")[0]
