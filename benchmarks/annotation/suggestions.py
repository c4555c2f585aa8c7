"""Leave-one-out over the templates of a generator folder: is the suggested form the one that was written?

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.annotation.suggestions [--folder F]
        [--declared] [--apart] [--show]

Each template line is left out in turn, together with every other line of the same pattern in any task
category, and a form is suggested for its pattern. Then the same from a command alone: the first command that is
now without a form gets a pattern, which gets a form. Equality is exact match of the canonical text. Predicates are
those of the templates that are left; with ``--declared`` those of all templates, as in a world whose predicates
were declared first. With ``--apart`` every template goes too whose pattern reads the same to the suggester, such as
one that only begins with ``$polite`` or has another name for its slot.

Last comes a table of how often the first form is right by its share of the weight of all candidates. A page fills the
form in above ``SURE_SHARE``.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

from annotations.language.corpus import wilson_interval
from annotations.language.forms import (
    Symbols,
    canonical_text,
    equivalent,
    print_sequence,
    to_template,
)
from annotations.language.templates import (
    SURE_SHARE,
    FormSuggester,
    PatternMaker,
    SemanticTemplate,
    Suggestion,
    TaskCategory,
    TemplateExpander,
    generate,
    make_template,
    read_generator_folder,
    template_checker,
)
from annotations.language.texts import Position
from annotations.language.world import Predicate
from benchmarks.fresh_site import DATA

SHARES = (0.0, 0.5, 0.6, 0.7, SURE_SHARE, 0.8, 0.9)


@dataclass(frozen=True)
class SuggestionOutcome:
    """What was suggested for one template that was left out. ``rank`` is 0 where its form is not among it.

    ``is_typed`` says for each suggestion whether the checker has nothing to say about the form; ``seconds`` is
    processor time, learning from the other templates included.
    """

    template: SemanticTemplate
    suggestions: tuple[Suggestion, ...]
    rank: int
    is_equivalent: bool
    is_typed: tuple[bool, ...]
    seconds: float


@dataclass(frozen=True)
class FromCommand:
    """The pattern made for the first uncovered command of a template that was left out.

    ``is_same_set`` says whether it makes exactly the commands that this template alone gives a form,
    ``is_right`` whether the first form suggested gives the command the form that the template gives it.
    """

    is_same_set: bool
    is_right: bool
    share: float


def leave_out(
    categories: Sequence[TaskCategory], patterns: Collection[Symbols]
) -> tuple[TaskCategory, ...]:
    """The categories without the templates of some patterns."""
    return tuple(
        replace(each, templates=tuple(t for t in each.templates if t.pattern not in patterns))
        for each in categories
    )


def alike(categories: Sequence[TaskCategory]) -> dict[Symbols, set[Symbols]]:
    """Pattern → the patterns with the same labels in the same order, itself included."""
    groups: dict[tuple[str, ...], set[Symbols]] = {}
    examples = FormSuggester(categories).examples
    for each in examples:
        groups.setdefault(tuple(u.label for u in each.units), set()).add(each.template.pattern)
    return {each.template.pattern: groups[tuple(u.label for u in each.units)] for each in examples}


def lines(categories: Sequence[TaskCategory]) -> Iterator[tuple[TaskCategory, SemanticTemplate]]:
    """Every template line with the first task category that uses it."""
    seen = set()
    for category in categories:
        for template in category.templates:
            if template.position not in seen:
                seen.add(template.position)
                yield category, template


def judge(
    category: TaskCategory, template: SemanticTemplate, suggester: FormSuggester
) -> SuggestionOutcome:
    start = time.process_time()
    suggestions = suggester.suggest(template.pattern, category.grammar)
    seconds = time.process_time() - start
    texts = [canonical_text(each.form) for each in suggestions]
    gold = canonical_text(template.form)
    return SuggestionOutcome(
        template,
        suggestions,
        texts.index(gold) + 1 if gold in texts else 0,
        bool(suggestions) and equivalent(suggestions[0].form, template.form),
        tuple(is_typed(template.pattern, each, category, suggester) for each in suggestions),
        seconds,
    )


def is_typed(
    pattern: Symbols, suggestion: Suggestion, category: TaskCategory, suggester: FormSuggester
) -> bool:
    """Whether the checker has nothing to say about the form of the suggested template."""
    template = replace(
        make_template(print_sequence(pattern), to_template(suggestion.form), Position("pattern")),
        form_position=Position("form"),
    )
    problems = template_checker(category.grammar, suggester.predicates).problems(template)
    return not any(problem.position.source == "form" for problem in problems)


def from_command(
    category: TaskCategory,
    template: SemanticTemplate,
    rest: Sequence[TaskCategory],
    suggester: FormSuggester,
) -> FromCommand | None:
    """None if the grammar derives no command that only this template gives a form."""
    expander = TemplateExpander(category.grammar)
    forms = dict(expander.pairs(template))
    covered = {expansion.command for expansion in generate(rest).expansions}
    known = tuple(each for one in rest for each in one.templates)
    maker = PatternMaker(category.grammar, known, covered)
    uncovered = [command for command in forms if command not in covered]
    pattern = maker.pattern(uncovered[0]) if uncovered else None
    if pattern is None:
        return None
    made = {" ".join(words) for words, _ in category.grammar.expander.stream(pattern)}
    suggestions = suggester.suggest(pattern, category.grammar)
    is_right, share = False, 0.0
    if suggestions:
        share = suggestions[0].share
        text = print_sequence(pattern), to_template(suggestions[0].form)
        suggested = dict(expander.pairs(make_template(*text)))
        is_right = suggested[uncovered[0]] == forms[uncovered[0]]
    return FromCommand(made == set(uncovered), is_right, share)


def print_by_share(title: str, firsts: Sequence[tuple[float, bool]]) -> None:
    """Print how many first suggestions are above a share, how many of them are right, and the 95 % interval.

    Args:
        firsts: of each pattern with a suggestion, the share of the first one and whether it is right.
    """
    print(title)
    for least in SHARES:
        above = [is_right for share, is_right in firsts if share > least]
        low, high = wilson_interval(sum(above), len(above)) if above else (0.0, 1.0)
        mark = "filled in" if least == SURE_SHARE else ""
        print(
            f"  share above {least:.2f}:    {part(sum(above), len(above))}, {low:.3f} to {high:.3f} {mark}"
        )


def part(count: int, total: int) -> str:
    return f"{count} of {total} ({100 * count / max(total, 1):.1f} %)"


def show(outcome: SuggestionOutcome) -> None:
    print(f"{outcome.rank or '–'}  {outcome.template.pattern_text}")
    print(f"     written    {to_template(outcome.template.form)}")
    for suggestion in outcome.suggestions[:2]:
        print(f"     suggested  {to_template(suggestion.form)}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, default=DATA / "generator-2018")
    parser.add_argument("--declared", action="store_true", help="all predicates are declared")
    parser.add_argument("--apart", action="store_true", help="leave out what reads the same too")
    parser.add_argument("--show", action="store_true", help="print the wrong ones")
    options = parser.parse_args()
    categories = read_generator_folder(options.folder).categories()
    declared: Mapping[str, Predicate] | None = None
    if options.declared:
        whole = FormSuggester(categories)
        declared = whole.predicates
    same = alike(categories)
    outcomes, answers = [], []
    for category, template in lines(categories):
        together = same[template.pattern] if options.apart else {template.pattern}
        rest = leave_out(categories, together)
        suggester = FormSuggester(rest, declared)
        outcomes.append(judge(category, template, suggester))
        answers.append(from_command(category, template, rest, suggester))
        if options.show and outcomes[-1].rank != 1:
            show(outcomes[-1])
    typed = [one for each in outcomes for one in each.is_typed]
    judged = [each for each in answers if each]
    print(f"equal at first:        {part(sum(o.rank == 1 for o in outcomes), len(outcomes))}")
    print(f"equivalent at first:   {part(sum(o.is_equivalent for o in outcomes), len(outcomes))}")
    print(f"among the first nine:  {part(sum(o.rank > 0 for o in outcomes), len(outcomes))}")
    print(f"well-typed:            {part(sum(typed), len(typed))} suggestions")
    print(f"without a suggestion:  {sum(not o.suggestions for o in outcomes)}")
    print(f"seconds for one:       {median(o.seconds for o in outcomes):.2f} (median)")
    print(f"same set of commands:  {part(sum(a.is_same_set for a in judged), len(judged))}")
    print(f"right from a command:  {part(sum(a.is_right for a in judged), len(judged))}")
    firsts = [(o.suggestions[0].share, o.rank == 1) for o in outcomes if o.suggestions]
    print_by_share("right at first, by share of the weight:", firsts)
    print_by_share(
        "right from a command, by share of the weight:", [(a.share, a.is_right) for a in judged]
    )


if __name__ == "__main__":
    main()
