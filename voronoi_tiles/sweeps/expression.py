"""Expressions over the columns of a table, to filter and to sort its rows: a small part of Python's, and no code.

Known are numbers, texts, columns by their names, comparisons (chained as well), `in`, `and`, `or`, `not`, arithmetic
and the functions below. A name such as `site[0].rotate` is one column. Nothing else is looked up or called.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any, Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.values import shown, suggestion

Kind = Literal["number", "text", "truth"]

LENGTH_MAX: Final = 2_000
"""Longest expression; characters."""

_FUNCTIONS: Final[Mapping[str, tuple[int | None, Callable[..., Any]]]] = {
    "abs": (1, np.abs),
    "sqrt": (1, np.sqrt),
    "log": (1, np.log),
    "round": (1, np.round),
    "min": (None, lambda *each: reduce(np.minimum, each)),
    "max": (None, lambda *each: reduce(np.maximum, each)),
}
"""What can be called, with the number of arguments, None for any."""

_ARITHMETIC: Final[Mapping[type, Callable[[Any, Any], Any]]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Mod: np.mod,
    ast.Pow: np.power,
}

_COMPARISONS: Final[Mapping[type, Callable[[Any, Any], Any]]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}

_LISTED: Final = 24
"""How many columns a message names, the shortest names first; a count."""

_KNOWN: Final = "Write comparisons, such as neck > 3 and curved_share >= 0.5."


class Column(NamedTuple):
    """The values of a column, or of an expression: float64 or bool (n,), or texts; NaN where there is no number."""

    kind: Kind
    values: NDArray[Any]


def evaluate(text: str, columns: Mapping[str, Column]) -> Column:
    """The values of an expression, one for each row.

    Comparisons with a number that is missing are false, but for `!=`. Raises DesignError, which says what cannot be.
    """
    if len(text) > LENGTH_MAX:
        raise DesignError(f"is longer than {LENGTH_MAX:,} characters", remedy=_KNOWN)
    try:
        tree = ast.parse(text.strip(), mode="eval")
        with np.errstate(all="ignore"):
            kind, values = _Evaluation(columns).of(tree.body)
    except DesignError:
        raise
    except SyntaxError as error:
        at = "" if error.offset is None else f" (column {error.offset})"
        raise DesignError(f"{shown(text)} is no expression: {error.msg}{at}", remedy=_KNOWN) from None
    except (ValueError, RecursionError, MemoryError) as error:
        raise DesignError(f"{shown(text)} is no expression: {error}", remedy=_KNOWN) from None
    count = len(next(iter(columns.values())).values) if columns else 1
    return Column(kind, np.broadcast_to(values, (count,)))


def without_sign(text: str) -> str:
    """An expression without the minus by which all of it is negated, where it is: what comes first, the greatest."""
    tree = ast.parse(text.strip(), mode="eval").body
    return ast.unparse(tree.operand if isinstance(tree, ast.UnaryOp) and isinstance(tree.op, ast.USub) else tree)


class _Evaluation:
    """What the parts of an expression come to."""

    def __init__(self, columns: Mapping[str, Column]) -> None:
        self._columns = columns

    def of(self, node: ast.expr) -> Column:
        """The values of a part."""
        match node:
            case ast.Name() | ast.Attribute() | ast.Subscript():
                found = self._column(ast.unparse(node))
            case ast.Constant(value):
                found = _constant(value)
            case ast.BoolOp(operation, parts):
                truths = [self._as("truth", part) for part in parts]
                combine = np.logical_and if isinstance(operation, ast.And) else np.logical_or
                found = Column("truth", reduce(combine, truths))
            case ast.UnaryOp(ast.Not(), part):
                found = Column("truth", np.logical_not(self._as("truth", part)))
            case ast.UnaryOp(ast.USub() | ast.UAdd() as sign, part):
                number = self._as("number", part)
                found = Column("number", -number if isinstance(sign, ast.USub) else number)
            case ast.BinOp(left, operation, right) if type(operation) in _ARITHMETIC:
                one, other = self._as("number", left), self._as("number", right)
                found = Column("number", _ARITHMETIC[type(operation)](one, other))
            case ast.Compare(left, operations, others):
                found = self._compared(left, operations, others)
            case ast.Call(ast.Name(name), arguments, []):
                found = self._called(name, arguments)
            case _:
                raise DesignError(f"{shown(ast.unparse(node))} is not known here", remedy=_KNOWN)
        return found

    def _as(self, kind: Kind, node: ast.expr) -> NDArray[Any]:
        """The values of a part that has to be of a kind."""
        found = self.of(node)
        if found.kind != kind:
            raise DesignError(
                f"{shown(ast.unparse(node))} is a {found.kind}, and a {kind} is needed there", remedy=_KNOWN
            )
        return found.values

    def _column(self, name: str) -> Column:
        """A column."""
        if name not in self._columns:
            near = suggestion(name, self._columns)
            names = sorted(self._columns, key=len)
            more = ", ..." if len(names) > _LISTED else ""
            known = f"Columns are {', '.join(names[:_LISTED])}{more}."
            raise DesignError(f"there is no column {name}", remedy=f"{near}{known}")
        return self._columns[name]

    def _compared(self, left: ast.expr, operations: list[ast.cmpop], others: list[ast.expr]) -> Column:
        """A chain of comparisons."""
        truths = []
        for operation, right in zip(operations, others, strict=True):
            if isinstance(operation, ast.In | ast.NotIn):
                truths.append(self._among(left, right) ^ isinstance(operation, ast.NotIn))
            elif type(operation) in _COMPARISONS:
                one = self.of(left)
                truths.append(_COMPARISONS[type(operation)](one.values, self._as(one.kind, right)))
            else:
                raise DesignError(f"{shown(ast.unparse(left))} cannot be compared so", remedy=_KNOWN)
            left = right
        return Column("truth", reduce(np.logical_and, truths))

    def _among(self, node: ast.expr, listed: ast.expr) -> NDArray[Any]:
        """Whether a part is one of some others."""
        if not isinstance(listed, ast.Tuple | ast.List | ast.Set) or not listed.elts:
            raise DesignError(
                f"{shown(ast.unparse(listed))} is no list of values",
                remedy="Write some, such as group in ('p3', 'p6').",
            )
        one = self.of(node)
        return reduce(np.logical_or, [one.values == self._as(one.kind, each) for each in listed.elts])

    def _called(self, name: str, arguments: list[ast.expr]) -> Column:
        """A function's result."""
        if name not in _FUNCTIONS:
            raise DesignError(
                f"there is no function {name}",
                remedy=f"{suggestion(name, _FUNCTIONS)}Functions are {', '.join(_FUNCTIONS)}.",
            )
        count, function = _FUNCTIONS[name]
        if not arguments or count not in (None, len(arguments)):
            raise DesignError(f"{name} takes {'one number' if count else 'numbers'}", remedy=_KNOWN)
        return Column("number", function(*(self._as("number", each) for each in arguments)))


def _constant(value: object) -> Column:
    """A value that is written."""
    match value:
        case bool():
            return Column("truth", np.array(value))
        case int() | float():
            try:
                return Column("number", np.array(float(value)))
            except OverflowError:
                raise DesignError("has a number that is too large", remedy=_KNOWN) from None
        case str():
            return Column("text", np.array(value))
    raise DesignError(f"{shown(value)} is not known here", remedy=_KNOWN)
