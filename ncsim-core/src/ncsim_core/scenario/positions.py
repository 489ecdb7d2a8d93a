"""Where the values and keys of a YAML text stand, and what YAML lets slip."""

from dataclasses import dataclass, field
from typing import NamedTuple

from ncsim_core.scenario.faults import Path


class Span(NamedTuple):
    """Where a value or key stands: line and column from 1, and how long it is."""

    line: int
    column: int
    length: int = 1


@dataclass(frozen=True)
class Positions:
    """Where each value and each key of a document stands."""

    values: dict[Path, Span] = field(default_factory=dict)
    keys: dict[Path, Span] = field(default_factory=dict)

    def find(self, path: Path, *, is_about_key: bool = False) -> Span | None:
        """Return where ``path`` stands, or the nearest value around it that is known."""
        if is_about_key and path in self.keys:
            return self.keys[path]
        for end in range(len(path), -1, -1):
            if path[:end] in self.values:
                return self.values[path[:end]]
        return None


class Slip(NamedTuple):
    """A fault of the YAML text itself."""

    path: Path
    span: Span
    message: str
    value: str | None = None
