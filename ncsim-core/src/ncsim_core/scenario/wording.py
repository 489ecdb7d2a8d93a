"""Schema errors in the words of the user: what is wrong, and what was probably meant."""

import math
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeAlias

from ncsim_core.registry.messages import close_match
from ncsim_core.registry.well_known import provider
from ncsim_core.scenario.faults import Path, Problem, shown
from ncsim_core.units import MAX_QUANTITY

Finding: TypeAlias = Any
"""A ``jsonschema.ValidationError``, whose fields depend on the keyword that failed."""

MAX_COMPARISONS = 20_000
"""Names that are compared with unknown ones; each costs some 20 us."""

MAX_TASKS_SHOWN = 20

_TYPE_WORDS = {
    "object": "a mapping",
    "array": "a list",
    "string": "text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "true or false",
    "null": "nothing",
}
_BOOLEAN_WORDS = {"yes": "true", "on": "true", "y": "true", "no": "false", "off": "false"}
_BOUND_WORDS = {
    "minimum": "at least",
    "maximum": "at most",
    "exclusiveMinimum": "greater than",
    "exclusiveMaximum": "less than",
}


def worded(path: Path, error: Finding) -> Iterable[Problem]:
    """Return a departure from the schema as problems for the user."""
    wording = _WORDINGS.get(str(error.validator))
    if wording is None:
        return [Problem(path, error.message, shown(error.instance))]
    return wording(path, error)


def did_you_mean(word: object, candidates: Iterable[str]) -> str | None:
    """Return the candidate that was probably meant by ``word``."""
    return close_match(str(word), candidates)


class Hints:
    """Suggestions out of one set of names; no more of them than can be found in a moment.

    Args:
        names: What could have been meant.
    """

    def __init__(self, names: Iterable[str]) -> None:
        self._names = sorted(names)
        self._words_left = max(1, MAX_COMPARISONS // max(1, len(self._names)))

    def hint(self, word: str) -> str | None:
        """Return the name that was probably meant by ``word``, ``None`` for the later words."""
        self._words_left -= 1
        return did_you_mean(word, self._names) if self._words_left >= 0 else None


def cycle_text(tasks: list[str]) -> str:
    """Return the tasks of a cycle in one line, those of a long one without its middle."""
    if len(tasks) > MAX_TASKS_SHOWN:
        half = MAX_TASKS_SHOWN // 2
        tasks = [*tasks[:half], f"({len(tasks) - 2 * half} more)", *tasks[-half:]]
    return " -> ".join(tasks)


def _unknown_keys(path: Path, error: Finding) -> Iterable[Problem]:
    known = error.schema.get("properties", {})
    for key in error.instance:
        if key not in known:
            yield _unknown_key(path, key, [each for each in known if each != "$schema"])


def _unknown_key(path: Path, key: str, known: list[str]) -> Problem:
    owner = provider("section", key) if path[-1:] == ("config",) else None
    if owner is not None:
        message = f"unknown key {key!r}; it comes with {owner}: pip install {owner}"
        return Problem((*path, key), message, key, is_about_key=True)
    meant = did_you_mean(key, known)
    listing = f"; known here: {', '.join(known) or 'none'}" if meant is None else ""
    return Problem((*path, key), f"unknown key {key!r}{listing}", key, meant, is_about_key=True)


def _missing_keys(path: Path, error: Finding) -> Iterable[Problem]:
    """Yield the one key that this error is about; there is an error for each."""
    known = error.schema.get("properties", {})
    for key in error.validator_value:
        if error.message == f"{key!r} is a required property":
            told = known.get(key, {}).get("description", "").rstrip(".")
            yield Problem(path, f"{missing_key(key)}: {told}" if told else missing_key(key))


def missing_key(key: str) -> str:
    """Return how the message about a missing key begins."""
    return f"{key!r} is missing"


def _wrong_type(path: Path, error: Finding) -> Iterable[Problem]:
    wanted = error.validator_value
    names = [wanted] if isinstance(wanted, str) else wanted
    expected = " or ".join(_TYPE_WORDS.get(name, name) for name in names)
    found = error.instance
    article = "the text " if isinstance(found, str) else ""
    message = f"must be {expected}, not {article}{shown(found)}{_advice(names, found)}"
    yield Problem(path, message, shown(found), _meant_value(names, found))


def _advice(wanted: list[str], found: object) -> str:
    if "string" in wanted and isinstance(found, bool | int | float):
        return "; put it in quotes"
    if isinstance(found, str) and {"number", "integer"} & set(wanted):
        return _number_advice(found)
    return ""


def _number_advice(text: str) -> str:
    """Return why a word that looks like a number is none."""
    if re.fullmatch(r"[-+]?\d+(:\d+)+(\.\d*)?", text):
        return " (write a time as a plain number of seconds)"
    if re.fullmatch(r"[-+]?0[0-9xob][0-9a-fA-F]*", text):
        return " (a leading zero means octal or hexadecimal to some readers; write a plain number)"
    if re.fullmatch(r"[-+]?[\d_,]+(\.\d*)?", text) and ("_" in text or "," in text):
        return " (write digits without separators)"
    if re.fullmatch(r"[-+]?\d+(\.\d*)?([eE][-+]?\d+)?", text):
        return " (remove the quotes)"
    if re.match(r"[-+]?\d", text):
        return " (write the number without a unit)"
    return ""


def _meant_value(wanted: list[str], found: object) -> str | None:
    if "boolean" in wanted and isinstance(found, str):
        return _BOOLEAN_WORDS.get(found.lower())
    return None


def _not_a_choice(path: Path, error: Finding) -> Iterable[Problem]:
    choices = [str(choice) for choice in error.validator_value]
    meant = did_you_mean(error.instance, choices)
    message = f"must be one of {', '.join(choices)}, not {shown(error.instance)}"
    yield Problem(path, message, shown(error.instance), meant)


def _out_of_bounds(path: Path, error: Finding) -> Iterable[Problem]:
    words = _BOUND_WORDS[str(error.validator)]
    wanted = f"{words} {error.validator_value}"
    if error.instance == math.inf and error.validator_value == MAX_QUANTITY:
        wanted = "a finite number"
    message = f"must be {wanted}, not {shown(error.instance)}"
    yield Problem(path, message, shown(error.instance))


def _too_short(path: Path, error: Finding) -> Iterable[Problem]:
    yield Problem(path, f"needs at least {error.validator_value}, has {len(error.instance)}")


def _wrong_text(path: Path, error: Finding) -> Iterable[Problem]:
    reason = "must not be empty" if error.instance == "" else "must be one line of plain text"
    yield Problem(path, f"{reason}, not {shown(error.instance)}", shown(error.instance))


_WORDINGS: Mapping[str, Callable[[Path, Finding], Iterable[Problem]]] = {
    "additionalProperties": _unknown_keys,
    "required": _missing_keys,
    "type": _wrong_type,
    "enum": _not_a_choice,
    "minItems": _too_short,
    "pattern": _wrong_text,
    **dict.fromkeys(_BOUND_WORDS, _out_of_bounds),
}
