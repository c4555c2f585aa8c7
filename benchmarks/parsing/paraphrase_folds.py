"""How a parser does on the paraphrases of a world, in five folds by form.

    .venv/bin/python -m benchmarks.parsing.paraphrase_folds WORLD SPLIT [--parser knn] [--protocol strict]
        [--seeds 3] [--folds 5] [--config KEY=VALUE …]

Learns from all generated commands of a split and from the paraphrases of four folds, and is asked those of the
fifth; the paraphrases of one form are in one fold. Prints how many answers have the heads of the form's actions, in
order (``heads``), the same constants (``named``) and those in order where the heads are right (``order``), the same
plan, and the same form; of all seeds together, with 95 % intervals (Wilson).
"""

from __future__ import annotations

import argparse
import os
from collections import Counter
from collections.abc import Callable, Iterator, Sequence

import django

from annotations.language.forms import (
    SEQUENCE,
    Application,
    Constant,
    Form,
    Lambda,
    read_form,
    walk,
)
from annotations.language.texts import Refusal


def heads(form: Form) -> list[str]:
    """Return the predicates of the actions of a form, in order."""
    if isinstance(form, Application) and form.predicate != SEQUENCE:
        return [str(form.predicate)]
    if isinstance(form, Lambda):
        inside = [body for body in form.bodies if isinstance(body, Application)]
        acting = [body for body in inside if body.predicate == SEQUENCE] or inside[:1]
        return [head for body in acting for head in heads(body)]
    steps = form.arguments if isinstance(form, Application) else ()
    return [head for step in steps for head in heads(step)]


def constants(form: Form) -> list[str]:
    return [str(part.value) for part in walk(form) if isinstance(part, Constant)]


def compare(
    answered: str, annotated: str, is_same_plan: Callable[[Form, Form], bool]
) -> Iterator[str]:
    """Yield the names of the measures by which an answer is right."""
    try:
        answer, form = read_form(answered), read_form(annotated)
    except Refusal:
        return
    if has_heads := heads(answer) == heads(form):
        yield "heads"
    if Counter(constants(answer)) == Counter(constants(form)):
        yield "named"
    if has_heads and constants(answer) == constants(form):
        yield "order"
    if is_same_plan(answer, form):
        yield "same plan"
    if answered == annotated:
        yield "exact match"


def folds_of(forms: Sequence[str], folds: int) -> list[int]:
    """Return the fold of each pair: forms in alphabetical order take turns."""
    place = {form: number % folds for number, form in enumerate(sorted(set(forms)))}
    return [place[form] for form in forms]


def main() -> None:
    given_by = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    given_by.add_argument("world")
    given_by.add_argument("split")
    given_by.add_argument("--parser", default="knn")
    given_by.add_argument("--protocol", default="strict")
    given_by.add_argument("--seeds", type=int, default=3)
    given_by.add_argument("--folds", type=int, default=5)
    given_by.add_argument("--config", nargs="*", default=[])
    given = given_by.parse_args()
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
    django.setup()
    from annotations.language.corpus import wilson_interval
    from annotations.models import Split, World
    from parser_service.management.options import read_hyperparameters
    from parser_service.parsers.registry import load_class, make_config
    from parser_service.runs.knowledge import knowledge_of, plan_agreement_of
    from parser_service.runs.split_pairs import as_pairs

    world = World.objects.get(name=given.world)
    pairs = as_pairs(Split.objects.get(world=world, name=given.split).examples.order_by("pk"))
    generated = [pair for pair in pairs if pair.source == "generated"]
    said = [pair for pair in pairs if pair.source == "paraphrased"]
    folds = folds_of([pair.form for pair in said], given.folds)
    config = make_config(given.parser, read_hyperparameters(given.parser, given.config))
    knowledge = knowledge_of(world, given.protocol)
    is_same_plan = plan_agreement_of(world)
    right: Counter[str] = Counter()
    for seed in range(given.seeds):
        for fold in range(given.folds):
            parser = load_class(given.parser)(config, seed, knowledge)
            known = [pair for pair, its in zip(said, folds, strict=True) if its != fold]
            asked = [pair for pair, its in zip(said, folds, strict=True) if its == fold]
            parser.fit([*generated, *known], known)
            answers = parser.predict([pair.utterance for pair in asked])
            for ranked, pair in zip(answers, asked, strict=True):
                right.update(compare(ranked[0].form if ranked else "", pair.form, is_same_plan))
    count = given.seeds * len(said)
    print(f"{given.parser}, {given.protocol}: {len(generated)} generated, {len(said)} paraphrased")
    for name in ("heads", "named", "order", "same plan", "exact match"):
        low, high = wilson_interval(right[name], count)
        share = f"{100 * right[name] / count:5.1f} %  [{100 * low:.1f}, {100 * high:.1f}]"
        print(f"{name:12} {right[name]:5} of {count}  {share}")


if __name__ == "__main__":
    main()
