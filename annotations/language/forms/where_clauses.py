"""The ``where`` clause of a wildcard: ``Property op value`` joined by and, or, xor, not."""

from __future__ import annotations

import re
from collections.abc import Callable
from math import isfinite

from annotations.language.forms.cursor import Cursor
from annotations.language.forms.symbols import (
    Combination,
    Comparison,
    Condition,
    Negation,
    Wildcard,
)

MAX_COMPARISONS = 32
# Weakest first; two conditions side by side with nothing between them are joined by "and".
_LEVELS = ("or", "xor", "and")
_NAME = re.compile(r"[^\W\d]\w*")
_OPERATOR = re.compile(r"!=|<>|>=|<=|=|>|<")
_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?([eE][-+]?\d+)?(?![\w.])")
_QUOTED = re.compile(r'"(?:[^"\\]|\\.)*"')
_WORD = re.compile(r"[^\s{}()|,;\"'=<>!\\]+")
_LITERALS: dict[str, bool | None] = {"true": True, "false": False, "null": None}
_META = re.compile(r"meta\s*:", re.IGNORECASE)

ReadWildcard = Callable[[], Wildcard]


def read_condition(cursor: Cursor, read_wildcard: ReadWildcard) -> Condition:
    """Read a condition up to the ``meta:`` or the brace that ends it.

    Precedence: ``not``, ``and``, ``xor``, ``or``. Property names become lower case, ``<>`` becomes
    ``!=``, and a missing ``and`` is added (GPSRCmdGen's own files leave it out).

    Raises:
        LanguageError: where a property, an operator or a value is missing, or where there are more
            than ``MAX_COMPARISONS``.
    """
    return _ConditionReader(cursor, read_wildcard).level(0)


class _ConditionReader:
    def __init__(self, cursor: Cursor, read_wildcard: ReadWildcard) -> None:
        self.cursor = cursor
        self.read_wildcard = read_wildcard
        self.comparisons = 0

    def level(self, depth: int) -> Condition:
        if depth == len(_LEVELS):
            return self.unary()
        operator = _LEVELS[depth]
        left = self.level(depth + 1)
        while self.word(operator) or (operator == "and" and self.starts_condition()):
            left = Combination(operator, left, self.level(depth + 1))
        return left

    def unary(self) -> Condition:
        negated = False
        while self.word("not"):
            negated = not negated
        operand = self.group() if self.cursor.next == "(" else self.comparison()
        return Negation(operand) if negated else operand

    def group(self) -> Condition:
        opening = self.cursor.index
        self.cursor.accept("(")
        inner = self.level(0)
        self.cursor.skip_spaces()
        if not self.cursor.accept(")"):
            raise self.cursor.fail("this parenthesis is never closed", "add a )", at=opening)
        return inner

    def comparison(self) -> Comparison:
        self.comparisons += 1
        if self.comparisons > MAX_COMPARISONS:
            raise self.cursor.fail(f"a where clause has more than {MAX_COMPARISONS} conditions")
        self.cursor.skip_spaces()
        name = self.cursor.match(_NAME)
        if name is None:
            raise self.cursor.fail(
                "a where clause needs a property here", 'write it like: where Category="food"'
            )
        self.cursor.skip_spaces()
        operator = self.cursor.match(_OPERATOR)
        if operator is None:
            raise self.cursor.fail(
                f"the property {name} needs an operator", "one of = != <> > >= < <="
            )
        return Comparison(name.lower(), operator.replace("<>", "!="), self.value())

    def value(self) -> str | float | bool | Wildcard | None:
        cursor = self.cursor
        cursor.skip_spaces()
        if cursor.next == "{":
            return self.read_wildcard()
        quoted = cursor.match(_QUOTED)
        if quoted is not None:
            return re.sub(r"\\(.)", r"\1", quoted[1:-1])
        number = cursor.match(_NUMBER)
        if number is not None:
            if not isfinite(float(number)):
                raise cursor.fail("this number is too large", "write fewer digits")
            return float(number)
        word = cursor.match(_WORD)
        if word is None:
            raise cursor.fail(
                "a value is missing here", "a string in quotes, a number, true, false, null"
            )
        return _LITERALS.get(word.lower(), word)

    def word(self, expected: str) -> bool:
        """Move past the keyword ``expected`` if it is next."""
        self.cursor.skip_spaces()
        start = self.cursor.index
        word = self.cursor.match(_NAME)
        if word is not None and word.lower() == expected:
            return True
        self.cursor.index = start
        return False

    def starts_condition(self) -> bool:
        """Return whether another condition begins here without an operator before it."""
        cursor = self.cursor
        cursor.skip_spaces()
        if cursor.next == "(":
            return True
        if _META.match(cursor.text, cursor.index):
            return False
        name = _NAME.match(cursor.text, cursor.index)
        return name is not None and name.group().lower() not in ("or", "xor")
