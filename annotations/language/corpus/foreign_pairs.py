"""Read the files of other λ-corpora: a sentence and its form, on one line with a tab or on two lines."""

from __future__ import annotations

import re
from collections.abc import Iterator

from annotations.language.corpus.written_pairs import PARTS, RecordFile, WrittenPair, contradictions
from annotations.language.forms import Form, canonical_text, read_foreign_form
from annotations.language.texts import (
    LanguageError,
    Position,
    Problem,
    error_at,
    read_text,
    say_count,
    warning_at,
)

_SUFFIXES = ("txt", "tsv", "ccg")
_BARE_LAMBDA = re.compile(r"(?:lambda|λ) [$?]\w")
_COMMENTS = ("//", "#", "%")
_STEMS = {name.removesuffix(".txt"): part for name, part in PARTS.items()}


def foreign_part(name: str) -> str:
    """Return the part that a file of another corpus is by its name, in any case; empty for any other file."""
    stem, _, suffix = name.lower().rpartition(".")
    return _STEMS.get(stem, "") if suffix in _SUFFIXES else ""


def read_foreign_pairs(data: bytes, source: str) -> RecordFile[WrittenPair]:
    """Read the pairs of a file whose forms ``read_foreign_form`` can read. Nothing is raised.

    Blank lines and comments are left out. ``written_form`` is the canonical text of the form.

    Returns:
        The pairs, and what could not be read: a warning for each reason, at the first place that has it, with the
        number of pairs. It is an error where no pair can be read.
    """
    try:
        text, problems = read_text(data, source)
    except LanguageError as error:
        return RecordFile((), (error.problem,))
    records: list[WrittenPair] = []
    forms: dict[str, Form] = {}  # form as it is written → its value
    reasons: dict[str, list[Problem]] = {}
    for sentence, written, place, below in _pairs(text, source):
        try:
            if not written:
                raise LanguageError("a sentence has no form", place)
            if not sentence:
                raise LanguageError("a form has no sentence", below)
            if written not in forms:
                forms[written] = read_foreign_form(written, below)
        except LanguageError as error:
            reasons.setdefault(error.message, []).append(error.problem)
        else:
            form = forms[written]
            records.append(WrittenPair(sentence, canonical_text(form), form, place))
    total = len(records) + sum(map(len, reasons.values()))
    for reason, left_out in reasons.items():
        count = f"{len(left_out):,} of {say_count(total, 'pair')} left out"
        problems.append(warning_at(left_out[0].position, f"{reason}: {count}, the first is here"))
    problems += contradictions(records)
    if not records:
        sentence = "no form here can be read as λ-calculus"
        problems.append(error_at(Position(source), sentence, "a form is like (lambda $0 e (p $0))"))
    return RecordFile(tuple(records), tuple(sorted(problems)))


def _pairs(text: str, source: str) -> Iterator[tuple[str, str, Position, Position]]:
    """Yield sentence and form with their places; one of the two is empty where it is missing."""
    waiting = None
    for number, line in enumerate(text.split("\n"), start=1):
        written = " ".join(line.split())
        place = Position(source, number)
        if not written or written.startswith(_COMMENTS):
            continue
        sentence, tab, form = line.partition("\t")
        if tab and form.strip():
            begin = len(sentence) + 1 + len(form) - len(form.lstrip())
            yield " ".join(sentence.split()), form.strip(), place, place.shifted(begin)
        elif written.startswith("(") or _BARE_LAMBDA.match(written):
            sentence, where = waiting or ("", place)
            yield sentence, line.strip(), where, place.shifted(len(line) - len(line.lstrip()))
            waiting = None
        else:
            if waiting:
                yield waiting[0], "", waiting[1], waiting[1]
            waiting = written, place
    if waiting:
        yield waiting[0], "", waiting[1], waiting[1]
