"""Print symbols in the notation of GPSRCmdGen; reading the text back gives equal symbols."""

from __future__ import annotations

import re

from annotations.language.forms.symbols import (
    Choice,
    Combination,
    Comparison,
    Condition,
    Negation,
    Nonterminal,
    Symbol,
    Symbols,
    Text,
    Wildcard,
)

# Brackets, bars and dollar signs have a meaning; the rest would begin a comment or end the head.
_MEANING = re.compile(r"[\\$(){}|,=#;%]|/(?=[/*])|-(?=>)")


def print_sequence(sequence: Symbols) -> str:
    """Print symbols on one line with single spaces between them, commas right after a word.

    A sequence that is one Choice is printed as top-level alternatives, without parentheses.
    """
    if len(sequence) == 1 and isinstance(sequence[0], Choice):
        return _alternatives(sequence[0])
    return " ".join(print_symbol(symbol) for symbol in sequence).replace(" , ", ", ")


def print_symbol(symbol: Symbol) -> str:
    """Return the text of one symbol."""
    match symbol:
        case Text(value):
            return value if value == "," else _MEANING.sub(r"\\\g<0>", value)
        case Nonterminal(name):
            return f"${name}"
        case Wildcard():
            return print_wildcard(symbol)
        case Choice():
            return f"({_alternatives(symbol)})"


def print_wildcard(wildcard: Wildcard) -> str:
    """Return the wildcard with its braces, its parts in the order of docs/reference/formats.md, Wildcards."""
    parts = [wildcard.name + ("?" if wildcard.obfuscated else "")]
    if wildcard.type:
        parts.append(wildcard.type)
    if wildcard.id is not None:
        parts.append(str(wildcard.id))
    if wildcard.where is not None:
        parts.append(f"where {print_condition(wildcard.where)}")
    if wildcard.meta:
        parts.append("meta: " + " ".join(print_symbol(symbol) for symbol in wildcard.meta))
    return "{" + " ".join(parts) + "}"


def print_condition(condition: Condition) -> str:
    """Print a condition with parentheses around every operand that is not a comparison."""
    match condition:
        case Comparison(name, operator, value):
            return f"{name} {operator} {_value(value)}"
        case Negation(operand):
            return f"not {_operand(operand)}"
        case Combination(operator, left, right):
            return f"{_operand(left)} {operator} {_operand(right)}"


def _operand(condition: Condition) -> str:
    text = print_condition(condition)
    return text if isinstance(condition, Comparison) else f"({text})"


def _value(value: str | float | bool | Wildcard | None) -> str:
    if isinstance(value, Wildcard):
        return print_wildcard(value)
    if isinstance(value, str):
        return '"' + re.sub(r'[\\"(){}#;%]|/(?=[/*])', r"\\\g<0>", value) + '"'
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    return repr(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)


def _alternatives(choice: Choice) -> str:
    return " | ".join(
        " ".join(print_symbol(symbol) for symbol in alternative)
        for alternative in choice.alternatives
    )
