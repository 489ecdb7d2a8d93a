"""Reads JSON strictly: plain data as fast as ``json.loads``, positions when a fault needs them.

What ``json`` lets pass is caught here: keys given twice, integers beyond any float, half a
surrogate pair. ``NaN`` and ``Infinity`` stay numbers, and are refused where YAML's are.
"""

import json
import re
from bisect import bisect_right
from collections.abc import Iterator
from typing import Any

from ncsim_core.scenario.positions import Positions, Slip, Span
from ncsim_core.scenario.yaml_text import MAX_INTEGER_DIGITS

_WORD = re.compile(r'[{}\[\],:]|"(?:[^"\\]|\\.)*"|[^\s{}\[\],:"]+')
_HALF_PAIR = re.compile(
    r"(?<!\\)(?:\\\\)*(?P<half>(?<!\\u[dD][89abAB]..)\\u[dD][c-fC-F]..|"
    r"\\u[dD][89abAB]..(?!\\u[dD][c-fC-F]))"
)


class RepeatedKeyError(Exception):
    """An object has a key twice."""


def read_json(text: str) -> Any:  # noqa: ANN401 - whatever the text holds
    """Return the data in a JSON text.

    Raises:
        json.JSONDecodeError: It is no JSON; the error knows where.
        RepeatedKeyError: A key is given twice; ``json_slips`` says which and where.
        RecursionError: It is nested too deep for Python.
    """
    half = _HALF_PAIR.search(text) if "\\u" in text else None
    if half:
        raise json.JSONDecodeError("Half a surrogate pair", text, half.start("half"))
    try:
        return json.loads(text, object_pairs_hook=_without_repeats, parse_int=_integer)
    except RepeatedKeyError:
        read_loosely(text)  # what comes after the key may be no JSON, which is the greater fault
        raise


def read_loosely(text: str) -> Any:  # noqa: ANN401 - whatever the text holds
    """Return the data in a JSON text, of keys that are given twice the last.

    Raises:
        json.JSONDecodeError: It is no JSON.
        RecursionError: It is nested too deep for Python.
    """
    return json.loads(text, parse_int=_integer)


def json_positions(text: str) -> Positions:
    """Return where each value and key of a valid JSON text stands."""
    return _Walk(text).positions


def json_slips(text: str) -> list[Slip]:
    """Return the keys of a valid JSON text that are given twice."""
    return _Walk(text).slips


def _without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    data = dict(pairs)
    if len(data) < len(pairs):
        raise RepeatedKeyError
    return data


def _integer(word: str) -> int | float:
    return int(word) if len(word) <= MAX_INTEGER_DIGITS else float(word)


class _Frame:
    """An object or a list that is still open; ``step`` leads to the value that comes next."""

    __slots__ = ("lines", "step", "wants_key")

    def __init__(self, *, is_object: bool) -> None:
        self.lines: dict[str, int] | None = {} if is_object else None
        self.step: str | int = "" if is_object else 0
        self.wants_key = is_object

    def pass_comma(self) -> None:
        self.wants_key = self.lines is not None
        if isinstance(self.step, int):
            self.step += 1


class _Walk:
    """One pass over the words of a valid JSON text."""

    def __init__(self, text: str) -> None:
        self.positions = Positions()
        self.slips: list[Slip] = []
        self._line_starts = [0, *(match.end() for match in re.finditer("\n", text))]
        self._frames: list[_Frame] = []
        for match in _WORD.finditer(text):
            self._take(match[0], match.start())

    def _take(self, word: str, at: int) -> None:
        frame = self._frames[-1] if self._frames else None
        if word in "}]":
            self._frames.pop()
        elif word == "," and frame is not None:
            frame.pass_comma()
        elif frame is not None and frame.wants_key:
            self._take_key(word, at, frame)
        elif word != ":":
            self.positions.values[tuple(self._steps())] = self._span(word, at)
            if word in "{[":
                self._frames.append(_Frame(is_object=word == "{"))

    def _take_key(self, word: str, at: int, frame: _Frame) -> None:
        key, span = json.loads(word), self._span(word, at)
        frame.step, frame.wants_key = key, False
        path = tuple(self._steps())
        self.positions.keys[path] = span
        lines = frame.lines if frame.lines is not None else {}
        if key in lines:
            message = f"key {key!r} is given twice, first on line {lines[key]}"
            self.slips.append(Slip(path, span, message, key))
        lines[key] = span.line

    def _steps(self) -> Iterator[str | int]:
        return (frame.step for frame in self._frames)

    def _span(self, word: str, at: int) -> Span:
        line = bisect_right(self._line_starts, at)
        return Span(line, at - self._line_starts[line - 1] + 1, len(word))
