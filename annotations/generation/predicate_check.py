"""What a predicate sounds like, and what is wrong with templates once it is declared so."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from annotations.language.forms import to_reading
from annotations.language.texts import LanguageError, Position
from annotations.language.world import Predicate, check_form, gloss, sample_forms
from annotations.models import SemanticTemplate, World
from annotations.rows.from_rows import classes_of, predicates_of, template_of

# Templates with a problem that they have not got now, each with what it says.
BrokenTemplates: TypeAlias = "tuple[tuple[SemanticTemplate, tuple[str, ...]], ...]"


@dataclass(frozen=True, slots=True)
class PredicateSample:
    """A form that uses the predicate, and its English sentence."""

    form: str
    sentence: str


@dataclass(frozen=True, slots=True)
class CheckedPredicate:
    """The English of a predicate, and the templates that it would break."""

    samples: tuple[PredicateSample, ...]
    templates: BrokenTemplates


def check_predicate(world: World, predicate: Predicate) -> CheckedPredicate:
    """Say ``predicate`` in English and check the templates of ``world`` with it."""
    before, classes = predicates_of(world), classes_of(world)
    after = {**before, predicate.name: predicate}
    samples = (
        PredicateSample(to_reading(form), gloss(form, after, classes))
        for form in sample_forms(predicate, after, classes)
    )
    return CheckedPredicate(tuple(samples), _broken(world, predicate.name, before, after))


def templates_without(world: World, name: str) -> BrokenTemplates:
    """Return the templates of ``world`` that have a problem once the predicate ``name`` is deleted."""
    before = predicates_of(world)
    after = {each: value for each, value in before.items() if each != name}
    return _broken(world, name, before, after)


def _broken(
    world: World, name: str, before: Mapping[str, Predicate], after: Mapping[str, Predicate]
) -> BrokenTemplates:
    """Return the templates that name the predicate and have a problem with ``after`` and not with ``before``."""
    place = Position("form")
    broken = []
    for row in SemanticTemplate.objects.filter(grammar__world=world, form__contains=name):
        try:
            form = template_of(row).form
        except LanguageError:
            continue
        known = set(check_form(form, before, place))
        problems = [each for each in check_form(form, after, place) if each not in known]
        if problems:
            broken.append((row, tuple(problem.message for problem in problems)))
    return tuple(broken)
