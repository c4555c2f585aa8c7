"""Offer repairs for the problems of a template.

Every candidate is tried: what is offered removes its problem, brings no new error and leaves fewer
problems than before, so that accepting repairs always ends.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import islice

from annotations.language.forms import DEFAULT_CLASSES, EntityClasses
from annotations.language.templates import slot_repairs, term_repairs, text_repairs
from annotations.language.templates.candidates import FORM, PATTERN, RepairCandidate
from annotations.language.templates.left_out import Usage, left_out, no_usage
from annotations.language.templates.template_checks import TemplateChecker
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.templates.trial import Sides, Trial
from annotations.language.texts import LanguageError, Offsets, Problem, Repair

MOST_PROBLEMS = 6  # of one template that repairs are looked for
MOST_TRIED = 150  # candidates of one problem
MOST_READ = 60_000  # characters of the candidates of one problem
MOST_OFFERED = 4  # repairs of one problem
MOST_BEHIND = 0.7  # by which the rank of an offer may be behind that of the first

# Whether the side is still unreadable, its errors, its problems, commands outside the grammar, the rank.
Rank = tuple[bool, int, int, int, float, str]


def with_repairs(
    problems: tuple[Problem, ...],
    sides: Sides,
    checker: TemplateChecker,
    usage: Callable[[], Usage] = no_usage,
    classes: EntityClasses = DEFAULT_CLASSES,
) -> tuple[Problem, ...]:
    """Return the problems with what can be done about each.

    Args:
        problems: their positions are in texts called "pattern" and "form", which ``sides`` holds.
        checker: of the task category that the template is for.
        usage: how other templates say slots; asked for only where the form leaves one out.
        classes: those that wildcards may be of.
    """
    offering = _Offering(sides, Trial(checker, classes), usage)
    return tuple(
        replace(problem, repairs=offering.repairs(problem) if number < MOST_PROBLEMS else ())
        for number, problem in enumerate(problems)
    )


class _Offering:
    """Works on the texts without the spaces around them; ``leads`` counts those in front."""

    def __init__(self, sides: Sides, trial: Trial, usage: Callable[[], Usage]) -> None:
        self.typed = sides
        self.leads = {
            source: len(sides.text(source)) - len(sides.text(source).lstrip())
            for source in (PATTERN, FORM)
        }
        self.sides = Sides(sides.pattern.strip(), sides.form.strip())
        self.trial = trial
        self.usage = usage
        self.template, self.before = trial.look(self.sides)
        self.counts = Counter(map(_identity, self.before))

    def repairs(self, problem: Problem) -> tuple[Repair, ...]:
        source = problem.position.source
        offset = Offsets(self.typed.text(source)).index(problem.position) - self.leads[source]
        candidates = (
            self._of_unreadable(source, offset)
            if self.template is None
            else self._of_readable(self.template, source, offset)
        )
        ranked: dict[Sides, tuple[Rank, RepairCandidate]] = {}
        most = MOST_READ // (len(self.sides.pattern) + len(self.sides.form) + 1)
        for candidate in islice(candidates, min(most, MOST_TRIED)):
            after = self.sides.after(candidate.repair)
            rank = self._try(problem, offset, candidate, after) if after != self.sides else None
            if rank is not None and (after not in ranked or rank < ranked[after][0]):
                ranked[after] = (rank, candidate)
        best: dict[
            str, RepairCandidate
        ] = {}  # by label, without those much less likely than the first
        for _, candidate in sorted(ranked.values(), key=lambda pair: pair[0]):
            if not best or candidate.rank <= next(iter(best.values())).rank + MOST_BEHIND:
                best.setdefault(candidate.repair.label, candidate)
        offered = [*best.values()][:MOST_OFFERED]
        repairs: list[Repair] = []  # of the texts as they were typed, with the spaces in front
        for candidate in offered:
            edits = tuple(
                replace(
                    edit,
                    start=edit.start + self.leads[edit.source],
                    end=edit.end + self.leads[edit.source],
                )
                for edit in candidate.repair.edits
            )
            repairs.append(replace(candidate.repair, edits=edits))
        return tuple(repairs)

    def _of_unreadable(self, source: str, offset: int) -> Iterator[RepairCandidate]:
        sides = self.sides
        text = sides.text(source)
        yield from text_repairs.wildcards(
            ((PATTERN, sides.pattern), (FORM, sides.form)), source, offset, self.trial.classes
        )
        yield from text_repairs.marks(text, source, offset)
        if source == PATTERN:
            yield from text_repairs.plain_quotes(text)
            yield from text_repairs.in_pattern(text, offset)
        else:
            yield from text_repairs.in_form(text, sides.pattern, offset)
            try:
                yield from term_repairs.unbound(text, offset)
                yield from text_repairs.moved_parentheses(text, offset)
            except LanguageError:
                pass  # other than a variable keeps it from being read
        yield from text_repairs.parentheses(text, source)

    def _of_readable(
        self, template: SemanticTemplate, source: str, offset: int
    ) -> Iterator[RepairCandidate]:
        grammar = self.trial.grammar
        if source == PATTERN:
            yield from text_repairs.plain_quotes(template.pattern_text)
            yield from slot_repairs.undefined(template, grammar, offset)
            yield from text_repairs.unheard(template, grammar)
            yield from left_out(template, self.usage, grammar, offset)
        else:
            yield from slot_repairs.form_only(template, grammar, offset)
            yield from term_repairs.misuse(template, self.trial.predicates, grammar, offset)

    def _try(
        self, problem: Problem, offset: int, candidate: RepairCandidate, sides: Sides
    ) -> Rank | None:
        """Return how good the template is after a repair; None where the repair does not help."""
        _, after = self.trial.look(sides)
        key = _identity(problem)
        if self.template is None:
            return self._rank_of_reading(key, offset, candidate, sides)
        outside = 0
        if key in self.counts:
            is_gone = Counter(map(_identity, after))[key] < self.counts[key]
            is_better = len(after) < len(self.before) and _errors(after) <= _errors(self.before)
            helps = is_gone and is_better
        else:  # the trial's problems do not say how many commands are outside the grammar
            outside = self.trial.outside(sides)
            helps = len(after) <= len(self.before) and outside < self.trial.outside(self.sides)
        rank = (False, _errors(after), len(after), outside, candidate.rank, candidate.repair.label)
        return rank if helps else None

    def _rank_of_reading(
        self,
        key: tuple[str, str],
        offset: int,
        candidate: RepairCandidate,
        sides: Sides,
    ) -> Rank | None:
        """Accept what lets the side be read, or moves its first error further on."""
        source, _ = key
        template, after = self.trial.look(sides)
        is_unread = template is None
        still = [other for other in after if is_unread and other.position.source == source]
        for other in still:
            at = Offsets(sides.text(source)).index(other.position)
            if _identity(other) == key or at <= offset:
                return None
        outside = self.trial.outside(sides) if source == PATTERN and not is_unread else 0
        return (
            bool(still),
            _errors(after),
            len(after),
            outside,
            candidate.rank,
            candidate.repair.label,
        )


def _identity(problem: Problem) -> tuple[str, str]:
    return problem.position.source, problem.message


def _errors(problems: tuple[Problem, ...]) -> int:
    return sum(problem.is_error for problem in problems)
