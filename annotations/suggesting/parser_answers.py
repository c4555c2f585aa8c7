"""Puts what parsers answer to a command among the forms suggested for the pattern that makes it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from annotations.generation.kept_expansions import checker_of, problems_of
from annotations.language.errors import LanguageError
from annotations.language.forms import canonicalize, read_form, to_template
from annotations.language.grammar import CHECK_STEPS, Budget
from annotations.language.predicates import Predicate, gloss
from annotations.language.suggesting import MOST_SUGGESTIONS, lift_forms
from annotations.language.templates import (
    TemplateChecker,
    TemplateExpander,
    make_template,
    read_sides,
)
from annotations.models import TaskCategory, World
from annotations.rows.from_rows import grammar_of, predicates_of
from annotations.suggesting.suggestions import ParserAnswer, SuggestedForm

MOST_LOOKED_AT = 2_000  # commands of a pattern


def command_for(category: TaskCategory, pattern: str, wanted: str = "") -> str:
    """Return ``wanted`` if it is a command of the pattern, else its first; empty where it makes none."""
    try:
        template = make_template(pattern, "UNKNOWN")
        pairs = TemplateExpander(grammar_of(category)).pairs(template, Budget(CHECK_STEPS))
        commands = dict(islice(pairs, MOST_LOOKED_AT))
    except LanguageError:
        return ""
    return wanted if wanted in commands else next(iter(commands), "")


def add_answers(
    world: World,
    category: TaskCategory,
    pattern: str,
    suggestions: Sequence[SuggestedForm],
    answers: Sequence[Sequence[ParserAnswer]],
) -> list[SuggestedForm]:
    """Return the suggestions with the first well-typed answer of each parser, marked as its own.

    What is new stands last, so that the others keep their digits while an answer comes.

    Args:
        answers: of each parser, ranked. Their forms are of one command of ``pattern``, with class tokens.
    """
    try:
        lifting = _Lifting(world, category, pattern)
    except LanguageError:
        return list(suggestions)
    by_text = {each.text: each for each in suggestions}
    added: list[str] = []
    for ranked in answers:
        text, answer = next(lifting.well_typed(ranked, by_text), ("", None))
        if answer is None:
            continue
        if text not in by_text:
            by_text[text] = SuggestedForm(text, lifting.gloss(text), "")
            added.append(text)
        by_text[text] = by_text[text].answered_by(answer)
    kept = [each.text for each in suggestions][: MOST_SUGGESTIONS - len(added)]
    return [by_text[text] for text in (*kept, *added)]


class _Lifting:
    """Reads answers as forms of one pattern. Raises LanguageError where the pattern cannot be read."""

    def __init__(self, world: World, category: TaskCategory, pattern: str) -> None:
        self.pattern = pattern
        self.symbols = make_template(pattern, "UNKNOWN").pattern
        self.predicates: Mapping[str, Predicate] = predicates_of(world)
        self.checker: TemplateChecker = checker_of(
            grammar_of(category), self.predicates, category.name
        )

    def well_typed(
        self, answers: Sequence[ParserAnswer], known: Mapping[str, SuggestedForm]
    ) -> Iterator[tuple[str, ParserAnswer]]:
        """Yield answers as forms of the pattern of which the checker says nothing; known ones are such."""
        for answer in answers:
            texts = list(self._lift(answer))
            typed = (text for text in texts if self._is_well_typed(text))
            text = next((text for text in texts if text in known), None) or next(typed, None)
            if text is not None:
                yield text, answer

    def gloss(self, text: str) -> str:
        """Return the English sentence of a form in the notation of templates."""
        return gloss(make_template(self.pattern, text).form, self.predicates)

    def _lift(self, answer: ParserAnswer) -> Iterator[str]:
        try:
            form = read_form(answer.form)
        except LanguageError:
            return
        for lifted in lift_forms(form, self.symbols, self.checker.grammar):
            yield to_template(canonicalize(lifted))

    def _is_well_typed(self, text: str) -> bool:
        template, _ = read_sides(self.pattern, text)
        problems = problems_of(self.checker, template) if template else ()
        return template is not None and not any(
            problem.is_error or problem.position.source == "form" for problem in problems
        )
