"""Keep what the checker says of ontology, grammar and templates up to date with their rows."""

from __future__ import annotations

from annotations.generation.template_problems import check_unready_templates
from annotations.language.texts import LanguageError, Problem
from annotations.language.world import ontology_problems
from annotations.models import Editable, Entity, Predicate, Production, TaskCategory, World
from annotations.models.description import ProblemSubject
from annotations.rows.from_rows import grammar_of, ontology_of
from annotations.rows.stored_problems import store_problems


def check_again(world: World, model: type[Editable]) -> None:
    """Store the problems of what rows of ``model`` make up, after one of them has changed.

    Templates that are ready are checked when their commands are brought up to date.
    """
    if model is Entity:
        store_problems(world, ProblemSubject.ONTOLOGY, tuple(ontology_problems(ontology_of(world))))
    elif model in (Production, TaskCategory):
        store_problems(world, ProblemSubject.GRAMMAR, grammar_problems(world))
    if model in (Production, TaskCategory, Predicate):
        check_unready_templates(world)


def grammar_problems(world: World) -> tuple[Problem, ...]:
    """Return the problems of the grammars of all task categories, each once, in the order of the files.

    A task category that has no productions yet has none.
    """
    problems: set[Problem] = set()
    for category in TaskCategory.objects.filter(grammar__world=world):
        try:
            grammar = grammar_of(category)
            problems |= set(grammar.problems() if grammar.productions else ())
        except LanguageError as error:
            problems.add(error.problem)
    return tuple(sorted(problems))
