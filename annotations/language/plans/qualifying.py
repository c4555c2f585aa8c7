"""What makes another request of a command, or none: what forbids, sets a condition, takes back, or asks for nothing.

No form has a place for them, so a parser that answers with the rest does what nobody asked for: "don't bring me the
honey" brings the honey.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import islice

from annotations.language.grounding import Anonymized
from annotations.language.plans.stating import states
from annotations.language.texts import (
    COMMAND_NOUNS,
    CONDITIONAL_PHRASES,
    COUNTING_PHRASES,
    EXCUSED_PHRASES,
    EXCUSING_PHRASES,
    FINISHED_WORDS,
    FORBIDDING_PHRASES,
    NUMBERS,
    ORDERING_PHRASES,
    POLITE_AFTER_IF,
    POLITE_BEFORE_IF,
    SEQUENCE_WORDS,
    SEVERAL_PHRASES,
    SUBJECT_WORDS,
    TAKING_BACK_PHRASES,
)

_LONGEST_BEFORE = 40  # characters before a name in which a number is looked for


class Qualified(StrEnum):
    """What makes another request of a command."""

    FORBIDDEN = "forbidden"
    CONDITION = "condition"
    NUMBER = "number"
    TAKEN_BACK = "taken_back"
    STATEMENT = "statement"


@dataclass(frozen=True, slots=True)
class Objection:
    """Why a robot does not do what it may have understood. ``code`` is one for machines, ``message`` a sentence;
    ``start`` and ``end`` are characters of the utterance."""

    code: str
    message: str
    start: int
    end: int


def _any_of(phrases: Iterable[str]) -> str:
    longest_first = sorted(phrases, key=len, reverse=True)
    return rf"\b(?:{'|'.join(map(re.escape, longest_first))})(?!\w)"


# "As soon as you are done" is no condition: it speaks of the command before.
_DONE = re.compile(
    rf"{_any_of((*CONDITIONAL_PHRASES, 'if'))}\s+(?:possible\b|(?:you|that|this|it|they)(?:'\w+)?"
    rf"(?:\s+[\w']+){{0,3}}?\s+{_any_of(FINISHED_WORDS)})",
    re.IGNORECASE,
)
# "It would make my day if you came" is a wish.
_WISH = re.compile(r"\b(?:i|it|we|that)(?:'d| would)(?:\s+[\w']+){0,5}?\s+if\b", re.IGNORECASE)
_EXCUSE = re.compile(_any_of(EXCUSING_PHRASES), re.IGNORECASE)
# A negation and what it belongs to: a clause ends at a sign or a joint.
_CLAUSE = re.compile(r"(?:(?!\b(?:and|so|but|because|since|then)\b)[^.,;:!?])+", re.IGNORECASE)
_NEGATION = re.compile(
    r"\b(?:not|never|no(?! one\b)|(?:nothing|nobody|no one)(?! (?:has|have|is|was|can)\b(?! (?:to|allowed)\b))|neither"
    r"|cannot|dont)(?!\w)|n't(?!\w)",
    re.IGNORECASE,
)
_EXCUSED = re.compile(rf"\W*(?:{_any_of(EXCUSED_PHRASES)})", re.IGNORECASE)
_ORDERING = re.compile(_any_of(ORDERING_PHRASES), re.IGNORECASE)
_REPORTING = re.compile(  # "Ann has not met you", "can't find it": a report, or "can't you"
    r"(?<!\w)(?:(?!you\b)\w+ (?:is|are|has|have|had|does|did|was|were) ?"
    r"|(?:ca|could|would|wo|is|are|have|has|does|did))$",
    re.IGNORECASE,
)
_WHY = re.compile(r"\bwhy ?\w*$", re.IGNORECASE)
_YOU = re.compile(r"\byou\b", re.IGNORECASE)
_ASKING = re.compile(r"\W*(?:can|could|will|would) you\b", re.IGNORECASE)
_SUBJECT = re.compile(
    rf"{_any_of(SUBJECT_WORDS)}|_ (?=\w)|\b(?:the|my|our|his|her|their) \w+ (?=(?:is|are|has|have|does|do|can|was)\b)",
    re.IGNORECASE,
)
_MOST_NEGATIONS = 8  # in one clause
_FORBIDDING = re.compile(_any_of(FORBIDDING_PHRASES), re.IGNORECASE)
_TAKING_BACK = re.compile(_any_of(TAKING_BACK_PHRASES), re.IGNORECASE)
# "should Robin ask": somebody else at the beginning of a sentence.
_SHOULD = r"(?:^|(?<=[.,;:!?]\s))should (?!you\b|i\b|we\b)(?=\w)"
# "when Robin comes", "once they are done": what somebody else does first.
# "When the first is done" speaks of a command.
_WHEN = (
    r"\b(?:when|once) (?:he|she|they|somebody|someone|anybody|anyone|nobody"
    rf"|the (?!{_any_of(COMMAND_NOUNS | SEQUENCE_WORDS)})\w+|_+)(?= \w)"
)
_CONDITION = re.compile(rf"{_any_of(CONDITIONAL_PHRASES)}|{_SHOULD}|{_WHEN}", re.IGNORECASE)
_IF = re.compile(
    rf"(?P<wish>{_any_of(POLITE_BEFORE_IF)},? )?\bif\b(?P<polite> {_any_of(POLITE_AFTER_IF)})?",
    re.IGNORECASE,
)
_COUNTING = re.compile(_any_of(COUNTING_PHRASES), re.IGNORECASE)
_NUMBER_BEFORE = re.compile(
    rf"(?:{_any_of((*NUMBERS[2:], *SEVERAL_PHRASES))}|\b(?:[2-9]|[1-9]\d+))\s+(?:of\s+)?(?:the\s+)?$",
    re.IGNORECASE,
)


def objections(heard: Anonymized) -> tuple[Objection, ...]:
    """Return what makes another request of a command, whatever a parser answers, in the order of the utterance.

    What stands in the name of an entity says nothing. Takes linear time.
    """
    text, end = "", 0
    for span in heard.spans:
        text += heard.original[end : span.start] + "_" * (span.end - span.start)
        end = span.end
    text = (text + heard.original[end:]).replace("’", "'")
    found = [*_qualified(text, heard.original), *_numbers(heard)]
    if states(text):
        message = "This tells me something and asks me for nothing."
        found.append(Objection(Qualified.STATEMENT, message, 0, len(text)))
    return tuple(sorted(found, key=lambda each: each.start))


def holds_in(utterance: str) -> Iterator[Objection]:
    """Yield what forbids, sets a condition or takes back, kind by kind. Takes linear time."""
    return _qualified(utterance.replace("’", "'"), utterance)


def is_qualified(utterance: str) -> bool:
    """Return whether an utterance forbids what it says, sets a condition, or takes it back.

    "I would be glad if you came" sets none. Takes linear time.
    """
    return any(True for _ in holds_in(utterance))


def says_number(heard: Anonymized) -> bool:
    """Return whether an utterance asks for several of what it names: "two apples", "both cups"."""
    return any(True for _ in _numbers(heard))


def _qualified(text: str, said: str) -> Iterator[Objection]:
    """Yield what ``text`` qualifies; ``said`` is the same with the names of entities in it."""

    def object_to(code: Qualified, start: int, end: int, message: str) -> Objection:
        return Objection(code, message.format(said[start:end].strip()), start, end)

    for harmless in (_DONE, _WISH):
        text = harmless.sub(_blank, text)
    ifs = [each for each in _IF.finditer(text) if not (each["wish"] or each["polite"])]
    text = _EXCUSE.sub(_blank, text)
    for match in _TAKING_BACK.finditer(text):
        yield object_to(Qualified.TAKEN_BACK, *match.span(), "“{}” takes back what was said.")
    text = _TAKING_BACK.sub(_blank, text)
    for clause in _CLAUSE.finditer(text):
        negation = _order_not_to(clause[0])
        if negation is not None:
            whole = object_to(Qualified.FORBIDDEN, *clause.span(), "“{}” forbids it.")
            yield replace(whole, start=clause.start() + negation.start())
    for match in _FORBIDDING.finditer(text):
        yield object_to(Qualified.FORBIDDEN, *match.span(), "“{}” forbids it.")
    for match in (*_CONDITION.finditer(text), *ifs):
        message = "“{}” sets a condition that I cannot check."
        yield object_to(Qualified.CONDITION, *match.span(), message)


def _blank(match: re.Match[str]) -> str:
    return "_" * len(match[0])


def _order_not_to(clause: str) -> re.Match[str] | None:
    """Return the negation with which a clause forbids something.

    A negation orders something where nobody is its subject ("bring me no milk"), where it is "you", or where the clause
    speaks of what is wanted ("I don't want you to"). "Can't you" asks for it.
    """
    for negation in islice(_NEGATION.finditer(clause), _MOST_NEGATIONS):
        before, after = clause[: negation.start()], clause[negation.end() :]
        if _EXCUSED.match(after) or negation[0] == clause.strip():
            continue
        if _ORDERING.search(clause):
            return negation
        is_report = _REPORTING.search(before) and not _YOU.search(before)
        if not (
            is_report or _WHY.search(before) or _ASKING.match(before) or _SUBJECT.search(before)
        ):
            return negation
    return None


def _numbers(heard: Anonymized) -> Iterator[Objection]:
    if _COUNTING.search(heard.original):
        return
    for span in heard.spans:
        begin = max(0, span.start - _LONGEST_BEFORE)
        match = _NUMBER_BEFORE.search(heard.original[begin : span.start])
        if match:
            said = heard.original[begin + match.start() : span.end]
            message = f"“{said}” are several; I take one thing at a time."
            yield Objection(Qualified.NUMBER, message, begin + match.start(), span.end)
