"""Reads YAML strictly: plain data, its positions, and everything wrong with the text itself.

The text is read as a stream of events, so that nesting has no depth at which it breaks, aliases can
be counted before they explode, and duplicate keys are seen. Positions are collected by a second
reading, and only when a fault must be explained.
"""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from ncsim_core.scenario.faults import Path, shown
from ncsim_core.scenario.positions import Positions, Slip, Span
from ncsim_core.scenario.yaml_text import plain_value

if TYPE_CHECKING:
    import yaml

MAX_DEPTH = 64
SHOWN_DEPTH = 4
"""Steps of a path that are shown when nesting goes too deep."""
MAX_ALIASED_VALUES = 100_000
TEXT_TAGS = frozenset({"!", "tag:yaml.org,2002:str"})

Event: TypeAlias = Any
"""A ``yaml.Event``, whose fields depend on its kind."""


class Reading(NamedTuple):
    """What a YAML text says.

    Args:
        document: Plain data; ``None`` if there is nothing or a slip made it unreadable.
        slips: Faults of the text itself.
        positions: Filled only on request.
    """

    document: Any
    slips: list[Slip]
    positions: Positions


def read_yaml(text: str, *, with_positions: bool = False) -> Reading:
    """Return the document in a YAML text, with all that is wrong with the text itself."""
    import yaml

    loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        return _read(yaml.parse(text, Loader=loader), with_positions=with_positions)
    except _TooDeepForLibyamlError:  # it looks ahead; the slower parser stops where we do
        return _read(yaml.parse(text, Loader=yaml.SafeLoader), with_positions=with_positions)


def _read(events: Iterator["yaml.Event"], *, with_positions: bool) -> Reading:
    import yaml

    reader = _Reader(with_positions=with_positions)
    try:
        for event in events:
            reader.take(event)
    except _UnreadableError as unreadable:
        return Reading(None, [*reader.slips, unreadable.slip], reader.positions)
    except yaml.MarkedYAMLError as error:
        if error.problem == "exceeded maximum nesting depth":
            raise _TooDeepForLibyamlError from None
        slip = Slip((), _mark_span(error), f"not valid YAML: {_reason(error)}")
        return Reading(None, [*reader.slips, slip], reader.positions)
    return Reading(reader.root, reader.slips, reader.positions)


def _mark_span(error: "yaml.MarkedYAMLError") -> Span:
    mark = error.problem_mark or error.context_mark
    return Span(mark.line + 1, mark.column + 1) if mark else Span(1, 1)


def _reason(error: "yaml.MarkedYAMLError") -> str:
    reasons = [error.context, error.problem, error.note]
    return ", ".join(reason for reason in reasons if reason)


class _TooDeepForLibyamlError(Exception):
    """Brackets nest deeper than libyaml (from 0.2.6 on) looks ahead, far beyond ``MAX_DEPTH``."""


class _UnreadableError(Exception):
    """The text cannot be read any further."""

    def __init__(self, slip: Slip) -> None:
        super().__init__(slip.message)
        self.slip = slip


class _Frame:
    """A mapping or list that is still open.

    Args:
        container: What is being filled.
        anchor: Name by which aliases may refer to it.
    """

    __slots__ = ("anchor", "container", "key", "key_lines", "size")

    def __init__(self, container: dict[str, Any] | list[Any], anchor: str | None) -> None:
        self.container = container
        self.anchor = anchor
        self.key: str | None = None
        self.key_lines: dict[str, int] = {}
        self.size = 1

    def wants_key(self) -> bool:
        return self.key is None and isinstance(self.container, dict)

    def place(self) -> str | int:
        """Return the last step of the path of the value that comes next."""
        return self.key if self.key is not None else len(self.container)

    def advice(self, key: object) -> str:
        """Return what to do about a key that is no text."""
        values = self.container.values() if isinstance(self.container, dict) else self.container
        before = next(reversed([*values]), None)
        if type(before) is int and type(key) is int:
            return f"put it in quotes, or write {before}.{key} if that is one number"
        return "put it in quotes"

    def put(self, value: object) -> None:
        if isinstance(self.container, list):
            self.container.append(value)
        elif self.key is not None:
            self.container[self.key] = value
            self.key = None


class _Reader:
    """Turns events into plain data without recursion."""

    def __init__(self, *, with_positions: bool) -> None:
        import yaml

        self.root: Any = None
        self.slips: list[Slip] = []
        self.positions = Positions()
        self._with_positions = with_positions
        self._frames: list[_Frame] = []
        self._anchors: dict[str, tuple[Any, int]] = {}
        self._documents = 0
        self._aliased_values = 0
        self._handlers = {
            yaml.ScalarEvent: self._take_scalar,
            yaml.MappingStartEvent: self._open_mapping,
            yaml.SequenceStartEvent: self._open_list,
            yaml.MappingEndEvent: self._close,
            yaml.SequenceEndEvent: self._close,
            yaml.AliasEvent: self._take_alias,
            yaml.DocumentStartEvent: self._start_document,
        }

    def take(self, event: Event) -> None:
        handler = self._handlers.get(type(event))
        if handler is not None:
            handler(event)

    def _start_document(self, event: Event) -> None:
        self._documents += 1
        if self._documents > 1:
            self._stop(event, "a second document begins here; a file holds one scenario")

    def _take_scalar(self, event: Event) -> None:
        value = plain_value(event.value) if event.implicit[0] else event.value
        if event.tag is not None and event.tag not in TEXT_TAGS:
            self._note(event, f"the YAML tag {event.tag!r} is not supported; write a plain value")
        if self._frames and self._frames[-1].wants_key():
            self._take_key(event, value)
            return
        self._record(event)
        self._remember(event.anchor, value, 1)
        self._put(value, 1)

    def _take_key(self, event: Event, value: object) -> None:
        frame = self._frames[-1]
        line = event.start_mark.line + 1
        frame.key = event.value
        if not isinstance(value, str):
            self._note(event, f"a key must be text, not {shown(value)}; {frame.advice(value)}")
        elif value == "<<" and event.implicit[0]:
            self._note(event, "merge keys are not supported; write the keys out")
        elif value in frame.key_lines:
            self._note(
                event, f"key {value!r} is given twice, first on line {frame.key_lines[value]}"
            )
        frame.key_lines[event.value] = line
        self._remember(event.anchor, value, 1)
        if self._with_positions:
            self.positions.keys[self._path()] = _span(event)

    def _open_mapping(self, event: Event) -> None:
        self._open(event, {})

    def _open_list(self, event: Event) -> None:
        self._open(event, [])

    def _open(self, event: Event, container: dict[str, Any] | list[Any]) -> None:
        if event.tag is not None:
            self._note(event, f"the YAML tag {event.tag!r} is not supported; write a plain value")
        if self._frames and self._frames[-1].wants_key():
            self._stop(event, "a key must be text, not a mapping or a list")
        if len(self._frames) >= MAX_DEPTH:
            del self._frames[SHOWN_DEPTH:]
            self._stop(event, f"nested more than {MAX_DEPTH} levels deep")
        self._record(event)
        self._frames.append(_Frame(container, event.anchor))

    def _close(self, event: Event) -> None:
        del event
        frame = self._frames.pop()
        self._remember(frame.anchor, frame.container, frame.size)
        self._put(frame.container, frame.size)

    def _take_alias(self, event: Event) -> None:
        if any(frame.anchor == event.anchor for frame in self._frames):
            self._stop(event, f"the alias *{event.anchor} stands inside what it refers to")
        if event.anchor not in self._anchors:
            self._stop(event, f"the alias *{event.anchor} refers to nothing above it")
        value, size = self._anchors[event.anchor]
        if self._frames and self._frames[-1].wants_key():
            self._stop(event, "an alias cannot be a key; write the key out")
        self._aliased_values += size
        if self._aliased_values > MAX_ALIASED_VALUES:
            self._stop(event, f"aliases stand for more than {MAX_ALIASED_VALUES} values")
        self._record(event)
        self._put(value, size)

    def _put(self, value: object, size: int) -> None:
        if self._frames:
            self._frames[-1].put(value)
            self._frames[-1].size += size
        else:
            self.root = value

    def _remember(self, anchor: str | None, value: object, size: int) -> None:
        if anchor is not None:
            self._anchors[anchor] = (value, size)

    def _record(self, event: Event) -> None:
        if self._with_positions:
            self.positions.values[self._path()] = _span(event)

    def _path(self) -> Path:
        return tuple(frame.place() for frame in self._frames if not frame.wants_key())

    def _note(self, event: Event, message: str) -> None:
        value = getattr(event, "value", None)
        self.slips.append(Slip(self._path(), _span(event), message, value))

    def _stop(self, event: Event, message: str) -> None:
        value = getattr(event, "value", None)
        raise _UnreadableError(Slip(self._path(), _span(event), message, value))


def _span(event: Event) -> Span:
    start, end = event.start_mark, event.end_mark
    length = end.column - start.column if end.line == start.line else 1
    return Span(start.line + 1, start.column + 1, max(1, length))
