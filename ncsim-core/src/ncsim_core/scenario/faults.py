"""What is wrong with a scenario, where, and how it is shown."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, TypeAlias

from ncsim_core.errors import ScenarioError

Path: TypeAlias = tuple[str | int, ...]
"""Keys and indices from the root of a document to a value."""

Data: TypeAlias = Any
"""Plain data as YAML or JSON gives it, its form not checked yet."""

MAX_SHOWN_FAULTS = 50
EXCERPT_WIDTH = 100
"""Characters of the offending line that are printed; longer lines are cut around the fault."""


@dataclass(frozen=True)
class Problem:
    """Something wrong at a path of a document, before it is known where that is in a file.

    Args:
        path: Where, in the document that was checked.
        message: What is wrong and what would be right.
        value: The offending value as text, if there is one.
        suggestion: What was probably meant, ready to be typed.
        is_about_key: The key is wrong, not its value.
    """

    path: Path
    message: str
    value: str | None = None
    suggestion: str | None = None
    is_about_key: bool = False


@dataclass(frozen=True)
class Fault:
    """One thing wrong with a scenario, located for its author.

    Args:
        path: Where in the scenario, such as ``network.links[2].to``; may be empty.
        line: Line in the file, from 1; ``None`` if the fault is not in a file.
        column: Column in that line, from 1.
        message: What is wrong and what would be right.
        value: The offending value as text, if there is one.
        suggestion: What was probably meant, ready to be typed.
        origin: The file, or the override, that the fault is in.
        pointer: Where in the document as written, as a JSON pointer (RFC 6901).
        line_text: The line of the file, to be printed with a caret.
        length: Characters that the caret underlines.
    """

    path: str
    line: int | None
    column: int | None
    message: str
    value: str | None = None
    suggestion: str | None = None
    origin: str = ""
    line_text: str = ""
    length: int = 1
    pointer: str = ""

    def render(self) -> str:
        """Return the fault as ``file:line:col  path: message``, with the line and a caret."""
        where = self.origin
        if self.line is not None:
            where += f":{self.line}:{self.column}"
        about = f"{self.path}: " if self.path else ""
        remedy = f"; did you mean {self.suggestion!r}?" if self.suggestion else ""
        text = f"{where}  {about}{self.message}{remedy}"
        if self.line is None or self.column is None or not self.line_text.strip():
            return text
        return f"{text}\n{_excerpt(self.line_text, self.line, self.column, self.length)}"

    def to_json(self) -> dict[str, object]:
        """Return the fault as plain data for ``--json``."""
        return {
            key: value for key, value in asdict(self).items() if key not in {"line_text", "length"}
        }


class ScenarioFaults(ScenarioError):  # noqa: N818 - it is named for what it lists
    """A scenario has faults, all of which are listed.

    Args:
        faults: In the order in which they are to be read.
    """

    def __init__(self, faults: Sequence[Fault]) -> None:
        self.faults = tuple(faults)
        super().__init__(_text(self.faults))

    def to_json(self) -> list[dict[str, object]]:
        """Return all faults as plain data."""
        return [fault.to_json() for fault in self.faults]


def path_text(path: Path) -> str:
    """Return a path as people write it, without the root that all paths share.

    >>> path_text(("scenario", "network", "links", 2, "to"))
    'network.links[2].to'
    """
    parts = path[1:] if path and path[0] == "scenario" else path
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in parts)
    return _printable(text.removeprefix("."))


def json_pointer(path: Path) -> str:
    """Return a path as a JSON pointer.

    >>> json_pointer(("scenario", "a/b", 2, "~"))
    '/scenario/a~1b/2/~0'
    """
    steps = (str(part).replace("~", "~0").replace("/", "~1") for part in path)
    return "".join(f"/{step}" for step in steps)


def original_path(path: Path, moved: Mapping[Path, Path]) -> Path:
    """Return where ``path`` was before its longest moved beginning was moved.

    >>> original_path(("scenario", "dags", 0), {("scenario",): ()})
    ('dags', 0)
    """
    for end in range(len(path), -1, -1):
        if path[:end] in moved:
            return (*moved[path[:end]], *path[end:])
    return path


def shown(value: object, width: int = 60) -> str:
    """Return an offending value as the user would recognise it, cut to ``width``."""
    if value is None:
        return "nothing"
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, list):
        return "a list"
    if isinstance(value, bool):
        return str(value).lower()
    text = repr(value) if isinstance(value, str | float) else str(value)
    return text if len(text) <= width else f"{text[: width - 3]}..."


def _printable(text: str) -> str:
    """Return text that does nothing to a terminal, at the same length."""
    return "".join(character if character.isprintable() else " " for character in text)


def _text(faults: Sequence[Fault]) -> str:
    lines = [fault.render() for fault in faults[:MAX_SHOWN_FAULTS]]
    if len(faults) > MAX_SHOWN_FAULTS:
        lines.append(f"... and {len(faults) - MAX_SHOWN_FAULTS} more faults")
    return "\n".join(lines)


def _excerpt(line_text: str, line: int, column: int, length: int) -> str:
    """Return the offending line with a caret line below it."""
    start = max(0, column - 1 - EXCERPT_WIDTH // 2) if len(line_text) > EXCERPT_WIDTH else 0
    window = _printable(line_text[start : start + EXCERPT_WIDTH])
    before = column - 1 - start
    carets = "^" * max(1, min(length, len(window) - before))
    return f"{line:>6} | {window}\n       | {' ' * before}{carets}"
