"""How values look in tables that people read."""

import re
from collections.abc import Mapping, Sequence
from typing import Any, Final

from ncsim_core.sweep.plan import canonical

DIGITS: Final = 3
"""Digits after the point of a measured number."""

_NUMBER: Final = re.compile(r"-?[0-9]+(\.[0-9]+)?%?")

_LATEX: Final[Mapping[str, str]] = {
    **{each: f"\\{each}" for each in "_%&#${}"},
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
}


def shown_value(value: object) -> str:
    """Return a value as the user gave it, or nearly so.

    >>> shown_value(0.5), shown_value(True), shown_value({"type": "fcp", "options": {"k": 2}})
    ('0.5', 'yes', 'fcp(k=2)')
    """
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, dict):
        return _component(value)
    return canonical(value) if isinstance(value, list | tuple) else str(value)


def measured(value: object, digits: int = DIGITS) -> str:
    """Return a measured value; all of a column have the same number of digits.

    >>> measured(12.5), measured(-0.00001), measured(7)
    ('12.500', '0.000', '7')
    """
    if not isinstance(value, float):
        return shown_value(value)
    text = f"{value:.{digits}f}"
    return text.removeprefix("-") if float(text) == 0 else text


def cells(rows: Sequence[Sequence[Any]], heads: int, digits: int) -> list[list[str]]:
    """Return the texts of a table whose first ``heads`` columns say what a row is about."""
    return [
        [shown_value(v) if i < heads else measured(v, digits) for i, v in enumerate(row)]
        for row in rows
    ]


def is_numeric(rows: Sequence[Sequence[Any]], column: int) -> bool:
    """Return whether a column holds numbers or nothing, and one number at least.

    >>> is_numeric([[1.5, "12%", "a"], [None, "7%", "1"]], 1)
    True
    """
    values = [row[column] for row in rows if row[column] is not None]
    return bool(values) and all(map(_is_number, values))


def _is_number(value: object) -> bool:
    if isinstance(value, str):
        return _NUMBER.fullmatch(value) is not None
    return isinstance(value, int | float) and not isinstance(value, bool)


def escaped_for_latex(text: str) -> str:
    r"""Return text that LaTeX sets as it is: numbers with a minus, nothing as a dash.

    >>> escaped_for_latex("a_b 50%"), escaped_for_latex("-1.5")
    ('a\\_b 50\\%', '$-1.5$')
    """
    if text == "-":
        return "--"
    if text.startswith("-") and _NUMBER.fullmatch(text):
        return f"${_escaped(text)}$"
    return _escaped(text)


def _escaped(text: str) -> str:
    return "".join(_LATEX.get(each, each) for each in text)


def escaped_for_markdown(text: str) -> str:
    """Return text that stays in its cell."""
    return text.replace("|", "\\|")


def _component(value: Mapping[str, Any]) -> str:
    """Return a component with the options that were given, or plain data as it is."""
    options = value.get("options", {})
    if "type" not in value or not isinstance(options, Mapping):
        return canonical(value)
    given = ", ".join(f"{name}={shown_value(each)}" for name, each in options.items())
    more = {k: v for k, v in value.items() if k not in ("type", "options")}
    given = ", ".join(filter(None, [given, *(f"{k}={shown_value(v)}" for k, v in more.items())]))
    return f"{value['type']}({given})" if given else str(value["type"])


UNITS: Final = {
    "s": "s", "us": "us", "m": "m", "MB": "MB", "hops": "hops", "MBps": "MB/s", "Mbps": "Mb/s",
    "dB": "dB", "dBm": "dBm", "mW": "mW", "mhz": "MHz", "ghz": "GHz", "MHz": "MHz", "GHz": "GHz",
}  # fmt: skip
"""Units as columns end in them, and as people read them."""


def quantity(column: str) -> str:
    """Return a column as an axis or a printed table names it; without a unit it stays a name.

    >>> quantity("mean_makespan_s"), quantity("dags.payload_MB"), quantity("round_robin")
    ('mean makespan (s)', 'payload (MB)', 'round_robin')
    """
    name = column.rpartition(".")[2]
    words = name.split("_")
    units: list[str] = []
    while words[1:] and words[-1] in UNITS:
        units.insert(0, UNITS[words.pop()])
    return f"{' '.join(words)} ({' '.join(units)})" if units else name
