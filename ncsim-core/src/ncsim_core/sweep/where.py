"""Conditions over the varied values: a small, safe expression language.

``network.size > 2 and scheduler != "heft"``: comparisons, ``and or not in``, arithmetic without
powers, numbers, text, lists. A name is a varied path, or its last word where that is unique. The
text is parsed by Python's own parser, and every node of the tree is checked; nothing is executed.
"""

import ast
import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, TypeAlias

from ncsim_core.errors import ScenarioError

Evaluate: TypeAlias = Callable[[Mapping[str, Any]], Any]

MAX_CHARACTERS: Final = 1000

_COMPARISONS: Final[Mapping[type[ast.cmpop], Callable[[Any, Any], Any]]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.In: lambda value, group: value in group,
    ast.NotIn: lambda value, group: value not in group,
}
_ARITHMETIC: Final[Mapping[type[ast.operator], Callable[[Any, Any], Any]]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
}
_SIGNS: Final[Mapping[type[ast.unaryop], Callable[[Any], Any]]] = {
    ast.Not: operator.not_,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}


class ConditionError(ScenarioError):
    """A condition cannot be understood, or does not fit the values."""


def condition(text: str, columns: Sequence[str]) -> Evaluate:
    """Return a function from the values of a run, by column, to whether the run is wanted.

    Raises:
        ConditionError: The text is no condition, or names something that is not varied.

    >>> condition("size * 2 > 4", ["network.size"])({"network.size": 3})
    True
    """
    if len(text) > MAX_CHARACTERS:
        raise ConditionError(f"is longer than {MAX_CHARACTERS} characters")
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        reason = error.msg if isinstance(error, SyntaxError) else str(error)
        raise ConditionError(f"cannot be read as a condition: {reason}") from None
    try:
        evaluate = _compiled(tree.body, spellings(columns))
    except RecursionError:
        raise ConditionError("cannot be read as a condition: it is nested too deeply") from None

    def is_wanted(values: Mapping[str, Any]) -> bool:
        try:
            return bool(evaluate(values))
        except RecursionError:
            raise ConditionError("is nested too deeply") from None
        except (TypeError, ZeroDivisionError, OverflowError) as error:
            raise ConditionError(f"does not fit the values {dict(values)}: {error}") from None

    return is_wanted


def spellings(columns: Sequence[str]) -> dict[str, str]:
    """Return the column of each valid name: the whole path, or its end where that is unique.

    >>> spellings(["network.size", "dags.size", "rf.tx_power_dBm"])["tx_power_dBm"]
    'rf.tx_power_dBm'
    """
    found: dict[str, list[str]] = {}
    for column in columns:
        words = column.split(".")
        for start in range(len(words)):
            found.setdefault(".".join(words[start:]), []).append(column)
    whole = {column: column for column in columns}
    return {name: each[0] for name, each in found.items() if len(each) == 1} | whole


def _compiled(node: ast.expr, names: Mapping[str, str]) -> Evaluate:
    if isinstance(node, ast.Constant):
        return _constant(node)
    if isinstance(node, ast.Name | ast.Attribute):
        return _name(node, names)
    if isinstance(node, ast.BoolOp):
        return _logic(node, names)
    if isinstance(node, ast.Compare):
        return _comparison(node, names)
    if isinstance(node, ast.BinOp | ast.UnaryOp):
        return _arithmetic(node, names)
    if isinstance(node, ast.List | ast.Tuple | ast.Set):
        members = [_compiled(each, names) for each in node.elts]
        return lambda values: [member(values) for member in members]
    raise _refused(node)


def _constant(node: ast.Constant) -> Evaluate:
    value = node.value
    if not isinstance(value, str | int | float | None):
        raise _refused(node)
    return lambda _: value


def _name(node: ast.expr, names: Mapping[str, str]) -> Evaluate:
    words = {"true": True, "false": False, "null": None}
    dotted = _dotted(node)
    if dotted in words:
        return lambda _: words[dotted]
    if dotted not in names:
        varied = ", ".join(dict.fromkeys(names.values())) or "nothing"
        raise ConditionError(f"{dotted!r} is not varied; varied here: {varied}")
    column = names[dotted]
    return lambda values: values[column]


def _dotted(node: ast.expr) -> str:
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        return f"{_dotted(node.value)}.{node.attr}"
    raise _refused(node)


def _logic(node: ast.BoolOp, names: Mapping[str, str]) -> Evaluate:
    parts = [_compiled(each, names) for each in node.values]
    if isinstance(node.op, ast.And):
        return lambda values: all(part(values) for part in parts)
    return lambda values: any(part(values) for part in parts)


def _comparison(node: ast.Compare, names: Mapping[str, str]) -> Evaluate:
    terms = [_compiled(each, names) for each in (node.left, *node.comparators)]
    if any(type(each) not in _COMPARISONS for each in node.ops):
        raise _refused(node)
    operators = [_COMPARISONS[type(each)] for each in node.ops]

    def evaluate(values: Mapping[str, Any]) -> bool:
        found = [term(values) for term in terms]
        pairs = zip(operators, found, found[1:], strict=False)
        return all(compare(one, other) for compare, one, other in pairs)

    return evaluate


def _arithmetic(node: ast.BinOp | ast.UnaryOp, names: Mapping[str, str]) -> Evaluate:
    if isinstance(node, ast.UnaryOp):
        if type(node.op) not in _SIGNS:
            raise _refused(node)
        sign, operand = _SIGNS[type(node.op)], _compiled(node.operand, names)
        return lambda values: sign(operand(values))
    if type(node.op) not in _ARITHMETIC:
        raise _refused(node)
    combine = _ARITHMETIC[type(node.op)]
    left, right = _compiled(node.left, names), _compiled(node.right, names)
    return lambda values: combine(_number(left(values)), _number(right(values)))


def _number(value: Any) -> float:  # noqa: ANN401 - a varied value
    """Return a number; text times a number would fill the memory."""
    if isinstance(value, int | float):
        return value
    raise TypeError(f"{value!r} is no number")


def _refused(node: ast.AST) -> ConditionError:
    text = ast.unparse(node)
    return ConditionError(
        f"{text!r} is not allowed; use comparisons, and, or, not, in, + - * / // %, numbers, text"
    )
