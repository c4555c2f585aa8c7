"""Which functions that read what people write cost more than linear time on text written to be slow.

Each of ``READERS`` reads texts that grow; it fails if four times the text takes more than ten times the
processor time. Limits of length count: a text that is refused at once costs nothing more.

    python -m benchmarks.language.hostile_readings

Exit status: 0 where every function is linear, else 1.
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass

from annotations.language.corpus import (
    EntityName,
    distance,
    read_pairs,
    rename_in_conditions,
    rename_in_template,
    words,
)
from annotations.language.forms import (
    places_in_form,
    places_in_pattern,
    read_form,
    read_spans,
    read_wildcard,
)
from annotations.language.grammar import (
    Grammar,
    find_heading,
    find_imports,
    read_production,
    read_productions,
    split_comments,
)
from annotations.language.grounding import Anonymizer
from annotations.language.templates import (
    Sides,
    correspondences,
    format_form,
    format_pattern,
    read_sides,
    read_template,
    read_templates,
    template_checker,
    with_repairs,
)
from annotations.language.texts import LanguageError
from annotations.language.world import (
    Ontology,
    read_entities,
    read_ontology,
    read_pattern,
    read_signatures,
)
from benchmarks.language.hostile_patterns import LIMIT, HostileText, seconds

SIZES = (1_200, 4_900, 19_600)  # characters: the last is above the limits of patterns and forms
NOISE = 0.1  # seconds of processor time below which nothing is said of growth
GROWTH = 10.0  # of the time, where the text grows fourfold
LOOKS = (1, 5)  # calls at first, and again before a text is called slow; the fastest counts

GRAMMAR = Grammar(read_productions("$Main = get the $thing\n$thing = cup | tea pot").productions)
ANONYMIZER = Anonymizer(
    Ontology(tuple(read_entities("tea\ntea pot\na a a\nkitchen", "object", {})))
)
APPLE = EntityName("object", "a b")

UNITS = (
    *("a", " ", "\n", "\t", "(", ")", "{", "}", "<", '"', "\\", "$", "|", ",", ";", "#", "%", "=", "*", "λ", "1"),
    *("a ", "$a ", "{a", "{a} ", "{object} ", "(a", "(a|", "(a|b)", "a|", "|a ", "/*", "/* */", "// a\n", "; a\n"),
    *("<a", "(a ", '(a "', '"a" ', "(a) ", "λx.", "(λ$1:e ", "lambda $1 e ", "a(", "a,", "a=", 'a="a" ', "a:", "meta:"),
    *("\\(", "\\a", "@a", "a\n", "$a = b\n", "{1}", "{1:", "{*", "a-", "a_", "where ", "{object where a=", "é", "the "),
    *("import a\n", "grammar name a ", "(a $1) ", "it ", "tea ", "a, b and ", "<object> ", "∧", "x & "),
)  # fmt: skip
HEADS = (
    "",
    "(",
    "a = (",
    "$a = ",
    "{",
    '"',
    "{object meta: ",
    "{object where ",
    "; grammar name ",
    "λx. ",
)
TAILS = ("", ")", "}", "\n(")


def _checked(sides: Sides) -> object:
    """Read both sides as the editor does, and look for repairs of what is wrong."""
    template, problems = read_sides(sides.pattern, sides.form)
    checker = template_checker(GRAMMAR, {})
    if template is not None:
        problems = (*problems, *checker.problems(template))
    correspondences(sides.pattern, sides.form, GRAMMAR)
    return with_repairs(problems, sides, checker)


READERS: Mapping[str, Callable[[str], object]] = {
    "read_form": read_form,
    "read_spans": read_spans,
    "format_form": format_form,
    "read_production": read_production,
    "read_productions": read_productions,
    "comments": lambda text: [
        (find_imports(comments), find_heading(comments, "name"))
        for _, comments in [split_comments(text, "", [])]
    ],
    "read_template": read_template,
    "read_templates": lambda text: list(read_templates(text)),
    "format_pattern": format_pattern,
    "places_in_pattern": places_in_pattern,
    "places_in_form": places_in_form,
    "read_wildcard": read_wildcard,
    "read_signatures": read_signatures,
    "read_gloss": read_pattern,
    "read_entities": lambda text: read_entities(text, "object", {}),
    "read_ontology": lambda text: read_ontology({"Objects.xml": text.encode()}),
    "read_pairs": lambda text: read_pairs(text.encode(), "pairs.txt"),
    "anonymize": ANONYMIZER.anonymize,
    "distance": lambda text: distance(text[:500], text[1:501]),
    "words": words,
    "rename_in_template": lambda text: rename_in_template(text, '(a "a b")', "a b", "c"),
    "rename_in_conditions": lambda text: rename_in_conditions(text, APPLE, "c"),
    "check a pattern": lambda text: _checked(Sides(text, "(a)")),
    "check a form": lambda text: _checked(Sides("get the cup", text)),
}


@dataclass(frozen=True)
class SlowReading:
    """A text that makes a reader slow, with seconds of processor time at each of ``SIZES``."""

    reader: str
    text: HostileText
    times: tuple[float, ...]

    def __str__(self) -> str:
        took = ", ".join(f"{each:.2f} s" for each in self.times)
        return f"{self.reader}: {took} for {self.text}"


def hostile_texts() -> Iterator[HostileText]:
    """Yield texts of one sign or word again and again, behind what may open something."""
    for unit in UNITS:
        for head in HEADS:
            yield HostileText(head, unit, "")
        for tail in TAILS[1:]:
            yield HostileText("", unit, tail)
    for unit, other in zip(UNITS, UNITS[7:] + UNITS[:7], strict=True):
        yield HostileText("", unit + other, "")


def slow_reading(reader: str, text: HostileText) -> SlowReading | None:
    """Return how slow ``reader`` is on ``text``, or None where it is linear or fast."""
    longer = itertools.count()

    def read(size: int) -> float:
        # A text that was read before may be remembered, so each is longer by a unit.
        written = text.of(size + next(longer) * len(text.unit))

        def run() -> None:
            with suppress(LanguageError):
                READERS[reader](written)

        return seconds(run)

    times = [LIMIT] * len(SIZES)
    for last in range(len(SIZES)):
        for repeats in LOOKS:
            for _, at in itertools.product(range(repeats), range(last + 1)):
                times[at] = min(times[at], read(SIZES[at]))
            grew = last > 0 and times[last] > max(NOISE, GROWTH * times[last - 1])
            if times[last] < LIMIT and not grew:
                break
        else:
            return SlowReading(reader, text, tuple(times[: last + 1]))
    return None


def main() -> int:
    slow = 0
    for reader in READERS:
        for text in hostile_texts():
            if reading := slow_reading(reader, text):
                slow += 1
                print(reading, flush=True)
                break
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
