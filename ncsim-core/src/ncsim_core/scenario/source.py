"""Where a scenario's text comes from, read with care, and where in it a fault lies."""

import codecs
import difflib
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path as FilePath
from typing import Any

from ncsim_core.scenario.faults import (
    Fault,
    Path,
    Problem,
    ScenarioFaults,
    json_pointer,
    original_path,
    path_text,
)
from ncsim_core.scenario.json_reader import (
    RepeatedKeyError,
    json_positions,
    json_slips,
    read_json,
    read_loosely,
)
from ncsim_core.scenario.positions import Positions, Slip, Span
from ncsim_core.scenario.yaml_reader import read_yaml

_UNPRINTABLE = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_BYTE_ORDER_MARKS = {b"\xff\xfe\x00\x00": "UTF-32", b"\xff\xfe": "UTF-16", b"\xfe\xff": "UTF-16"}


MAX_BYTES = 256 << 20


@dataclass(frozen=True)
class Source:
    """A text and its name.

    Args:
        name: What faults call it: the path of the file.
        text: The text; empty when the scenario came as plain data.
        is_json: Whether the text must be JSON.
    """

    name: str
    text: str = ""
    is_json: bool = False

    @cached_property
    def _lines(self) -> list[str]:
        return self.text.split("\n") if self.may_be_json() else self.text.splitlines()

    def may_be_json(self) -> bool:
        """Return whether the text is to be read as JSON first."""
        return self.is_json or self.text.lstrip().startswith("{")

    def lone_fault(self, message: str, span: Span | None = None) -> ScenarioFaults:
        """Return the error for a source with one fault that leaves nothing to check."""
        return ScenarioFaults([self.fault("", span, message)])

    def fault(
        self,
        path: str,
        span: Span | None,
        message: str,
        value: str | None = None,
        suggestion: str | None = None,
    ) -> Fault:
        """Return a fault of this source, with the line it stands on."""
        fault = Fault(path, None, None, message, value, suggestion, origin=self.name)
        if span is None:
            return fault
        return replace(
            fault,
            line=span.line,
            column=span.column,
            line_text=self._lines[span.line - 1] if span.line <= len(self._lines) else "",
            length=span.length,
        )


def read_source(path: FilePath) -> Source:
    """Return the text of a file.

    Raises:
        ScenarioFaults: There is no such file, or it is not UTF-8 text.
    """
    source = Source(str(path))
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise source.lone_fault(f"no such file{_near_file(path)}") from None
    except IsADirectoryError:
        raise source.lone_fault("is a directory, not a scenario file") from None
    except OSError as error:
        raise source.lone_fault(f"cannot be read: {error.strerror or error}") from None
    if len(data) > MAX_BYTES:
        raise source.lone_fault(f"is larger than {MAX_BYTES >> 20} MiB; no scenario is", Span(1, 1))
    return Source(str(path), _decoded(data, source), path.suffix.lower() == ".json")


def read_document(source: Source) -> tuple[Any, list[Slip]]:
    """Return the data in a source, and what is wrong with its text.

    Raises:
        ScenarioFaults: There is no data that could be checked any further.
    """
    _refuse_unprintable(source)
    if not source.text.strip():
        raise source.lone_fault("is empty; a scenario begins with 'scenario:'", Span(1, 1))
    read = _read_as_json(source) if source.may_be_json() else None
    document, slips = read if read is not None else read_yaml(source.text)[:2]
    if document is None and not slips:
        raise source.lone_fault("is empty; a scenario begins with 'scenario:'", Span(1, 1))
    if not isinstance(document, dict):
        slips = slips or [_not_a_mapping(document)]
        raise ScenarioFaults([_slip_fault(source, slip) for slip in slips])
    return document, slips


OVERRIDABLE = 2
"""Steps from the root to what overrides change: ``scenario.config``."""


@dataclass(frozen=True)
class Origins:
    """Where the parts of a checked document came from.

    Args:
        moved: By path in the checked document, the path in the source it was taken from.
        overrides: By path in the checked document, how the user wrote the override.
    """

    moved: Mapping[Path, Path] = field(default_factory=dict)
    overrides: Mapping[Path, str] = field(default_factory=dict)

    def override_of(self, path: Path) -> str | None:
        """Return the override that ``path`` lies in, or that has changed what lies below it."""
        for end in range(len(path), 0, -1):
            if path[:end] in self.overrides:
                return self.overrides[path[:end]]
        beyond = (text for at, text in self.overrides.items() if at[: len(path)] == path)
        return next(beyond, None) if len(path) > OVERRIDABLE else None

    def source_path(self, path: Path) -> Path:
        """Return where in the source ``path`` was taken from."""
        return original_path(path, self.moved)


def located(
    problems: Iterable[Problem], slips: Iterable[Slip], source: Source, origins: Origins
) -> ScenarioFaults:
    """Return the error that reports all problems, in the order of the text."""
    positions = _positions(source)
    faults = [_slip_fault(source, slip) for slip in slips]
    told = {slip.path for slip in slips}
    faults += [
        _fault(problem, source, positions, origins)
        for problem in problems
        if origins.source_path(problem.path) not in told
    ]
    faults.sort(key=lambda each: (each.line or 0, each.column or 0))
    return ScenarioFaults(faults)


def _fault(problem: Problem, source: Source, positions: Positions, origins: Origins) -> Fault:
    override = origins.override_of(problem.path)
    path = origins.source_path(problem.path)
    if override is not None:
        source, span = Source(f"override {override}"), None
    else:
        span = positions.find(path, is_about_key=problem.is_about_key)
    fault = source.fault(
        path_text(problem.path), span, problem.message, problem.value, problem.suggestion
    )
    return replace(fault, pointer=json_pointer(path))


def _slip_fault(source: Source, slip: Slip) -> Fault:
    fault = source.fault(path_text(slip.path), slip.span, slip.message, slip.value)
    return replace(fault, pointer=json_pointer(slip.path))


def _not_a_mapping(document: object) -> Slip:
    form = "a list" if isinstance(document, list) else "a single value"
    return Slip((), Span(1, 1), f"must be a mapping that begins with 'scenario:', not {form}")


def _near_file(path: FilePath) -> str:
    try:
        names = sorted(each.name for each in path.parent.iterdir())
    except OSError:
        return ""
    near = difflib.get_close_matches(path.name, names, n=1)
    return f"; did you mean {str(path.parent / near[0])!r}?" if near else ""


def _decoded(data: bytes, source: Source) -> str:
    for mark, encoding in _BYTE_ORDER_MARKS.items():
        if data.startswith(mark):
            raise source.lone_fault(f"is {encoding} text; save it as UTF-8", Span(1, 1))
    data = data.removeprefix(codecs.BOM_UTF8)
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        before = data[: error.start].decode("utf-8")
        message = f"is not UTF-8 text: byte 0x{data[error.start]:02x}; save it as UTF-8"
        raise Source(source.name, before).lone_fault(message, _end_of(before)) from None


def _end_of(text: str) -> Span:
    """Return the position right after ``text``."""
    lines = f"{text}.".splitlines()
    return Span(len(lines), len(lines[-1]))


def _refuse_unprintable(source: Source) -> None:
    found = _UNPRINTABLE.search(source.text)
    if found:
        name = "a NUL" if found[0] == "\0" else f"the character U+{ord(found[0]):04X}"
        message = f"holds {name}; a scenario is plain text"
        raise source.lone_fault(message, _end_of(source.text[: found.start()]))


def _read_as_json(source: Source) -> tuple[Any, list[Slip]] | None:
    """Return what a JSON text says, or ``None`` if the YAML reader should look at it.

    Raises:
        ScenarioFaults: It has to be JSON and is not.
    """
    try:
        return read_json(source.text), []
    except json.JSONDecodeError as error:
        if not source.is_json:
            return None
        span = Span(error.lineno, error.colno)
        raise source.lone_fault(f"not valid JSON: {error.msg}", span) from None
    except RepeatedKeyError:
        return read_loosely(source.text), json_slips(source.text)
    except RecursionError:
        return None


def _positions(source: Source) -> Positions:
    """Return where everything stands, by the reader that has read the text."""
    if not source.may_be_json():
        return read_yaml(source.text, with_positions=True).positions
    try:
        read_loosely(source.text)
    except (ValueError, RecursionError):
        return read_yaml(source.text, with_positions=True).positions
    return json_positions(source.text)
