"""Which plain YAML words are numbers and booleans, and YAML text written accordingly.

YAML 1.1, which PyYAML implements, reads ``12:30`` as 750, ``017`` as 15, ``yes`` as true and
``5e9`` as text. Scenarios follow YAML 1.2 instead, and where 1.1 and 1.2 disagree about a number
(``017``, ``0x1F``, ``1_000``) the word stays text, so that no reader is surprised.
"""

import math
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import yaml

CONSTANTS: Mapping[str, bool | None] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
}
INTEGER = re.compile(r"[-+]?(?:0|[1-9][0-9]*)\Z")
NUMBER = re.compile(r"[-+]?(?:\.[0-9]+|(?:0|[1-9][0-9]*)(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?\Z")
INFINITE = re.compile(r"([-+]?)\.(?:inf|Inf|INF)\Z")
NOT_A_NUMBER = re.compile(r"\.(?:nan|NaN|NAN)\Z")
MAX_INTEGER_DIGITS = 300
"""Longer integers are beyond any float, and read as infinite."""

_FIRST_OF_A_NUMBER = frozenset("0123456789+-.")


def plain_value(word: str) -> str | int | float | bool | None:
    """Return what an unquoted YAML word means.

    >>> [plain_value(word) for word in ("5e9", "7", "yes", "12:30", "017", "true", "~")]
    [5000000000.0, 7, 'yes', '12:30', '017', True, None]
    """
    if word in CONSTANTS:
        return CONSTANTS[word]
    if word[0] not in _FIRST_OF_A_NUMBER:
        return word
    number = _number(word)
    return word if number is None else number


def dump_yaml(document: object) -> str:
    """Return a document as YAML that YAML 1.1 and 1.2 readers understand alike."""
    import yaml

    return yaml.dump(
        document,
        Dumper=_dumper(),
        sort_keys=False,
        default_flow_style=None,
        allow_unicode=True,
        width=120,
    )


def _number(word: str) -> int | float | None:
    if INTEGER.match(word) and len(word) <= MAX_INTEGER_DIGITS:
        return int(word)
    if NUMBER.match(word):
        return float(word)
    infinite = INFINITE.match(word)
    if infinite:
        return -math.inf if infinite[1] == "-" else math.inf
    return math.nan if NOT_A_NUMBER.match(word) else None


def _dumper() -> type["yaml.SafeDumper"]:
    """Return a dumper that also quotes text such as ``5e9``, a number in YAML 1.2 only."""
    import yaml

    class Dumper(getattr(yaml, "CSafeDumper", yaml.SafeDumper)):  # type: ignore[misc]
        """Knows the numbers of both versions of YAML."""

        def ignore_aliases(self, data: object) -> bool:
            """Write shared values out; an alias would puzzle readers."""
            del data
            return True

    Dumper.add_implicit_resolver("tag:yaml.org,2002:float", NUMBER, list("-+.0123456789"))
    return Dumper
