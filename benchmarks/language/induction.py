"""What the oracle makes of a world that was proposed from a few commands.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.language.induction [--draws 10]

The domains beside this module have 20 commands each, what a person answered to the proposals, and 40 wordings that were
written before. Of ``generator-2018``, commands are drawn with their forms: shown are the shares of the others that are
understood as their gold, and as something else; and what the templates of the drawn commands, with the whole grammar,
would give.
"""

from __future__ import annotations

import argparse
import random
import tomllib
from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from annotations.language.forms import (
    Application,
    Constant,
    EntityClasses,
    Form,
    Lambda,
    canonical_text,
    read_form,
    to_corpus,
)
from annotations.language.grounding import Anonymizer
from annotations.language.induction import (
    KnownWorld,
    OfferKind,
    Proposal,
    category_of,
    propose,
    read_example,
    with_class_named,
    with_predicate_named,
    with_proposal,
)
from annotations.language.templates import (
    Balance,
    Language,
    SampleRequest,
    TemplateChart,
    generate,
    read_generator_folder,
)
from annotations.language.world import Ontology, read_ontology
from benchmarks.fresh_site import DATA
from parser_service.parsers.interface import Candidate, Knowledge
from parser_service.parsers.oracle import GrammarOracle

DOMAINS = Path(__file__).parent / "domains"
COMPETITION = Path("annotations/starter/competition")
DRAWN = (5, 10, 20)
SAMPLED = 1_000


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--draws", type=int, default=10)
    print("domain       corrections  understood  as something else, of 40 wordings")
    for path in sorted(DOMAINS.glob("*.toml")):
        domain = tomllib.loads(path.read_text(encoding="utf-8"))
        for kinds in ((), tuple(OfferKind)[:2]):
            text, corrections = corrected(domain, kinds)
            right, wrong = understood(domain, oracle_of(propose(text)))
            print(f"{path.stem:12} {corrections:>11} {right:>11} {wrong:>18}")
    print(
        "language  drawn, of the others in %: understood, as something else, by the templates of those"
    )
    for make in (generator_pairs, competition_pairs, paraphrase_pairs):
        forms, by_template = make()
        for drawn in DRAWN:
            shares = shares_of(forms, by_template, drawn, options.parse_args().draws)
            print(f"{make.__name__:17} {drawn:>4}", *(f"{100 * share:>8.1f}" for share in shares))


def corrected(domain: Mapping[str, Any], kinds: Sequence[OfferKind] = ()) -> tuple[str, int]:
    """Return the examples as a person corrects them, with all offers of some kinds, and the number of answers."""
    text, corrections = domain["examples"].strip(), 0
    for member, name in domain["corrections"]["classes"].items():
        proposal = propose(text)
        token = next(
            each.token
            for each in proposal.classes
            if member.replace("_", " ") in map(str.lower, each.texts)
        )
        corrections += token != name
        text = with_class_named(text, proposal, token, name)
    for old, new in domain["corrections"]["predicates"].items():
        text = with_predicate_named(text, propose(text), old, new)
        corrections += 1
    offers = [each.line for each in propose(text).offers if each.kind in kinds]
    return "\n".join([text, *offers]), corrections + len(kinds)


def oracle_of(proposal: Proposal) -> GrammarOracle:
    """Return the oracle of a world that has what is proposed and nothing else."""
    ontology = with_proposal(Ontology((), EntityClasses(())), proposal, KnownWorld())
    return GrammarOracle(knowledge=Knowledge(grammar=(category_of(proposal),), ontology=ontology))


def grounded(candidate: Candidate) -> Form:
    """Return the form of a candidate with its values in place of the class tokens."""
    values: Iterator[str | None] = iter(candidate.values or ())

    def fill(form: Form) -> Form:
        match form:
            case Constant():
                return Constant(next(values, None) or form.value)
            case Lambda(variable, type_, bodies):
                return Lambda(variable, type_, tuple(map(fill, bodies)))
            case Application(predicate, arguments):
                return Application(predicate, tuple(map(fill, arguments)))
            case _:
                return form

    return fill(read_form(candidate.form))


def understood(domain: Mapping[str, Any], oracle: GrammarOracle) -> tuple[int, int]:
    """Return how many held-out wordings get their form, and how many another one."""
    right = wrong = 0
    for wording in domain["held_out"]:
        candidates = oracle.predict([wording["said"]])[0]
        answer = canonical_text(grounded(candidates[0])) if candidates else ""
        means = canonical_text(read_form(wording["means"])) if wording["means"] else ""
        right += answer == means
        wrong += bool(answer) and answer != means
    return right, wrong


def generator_pairs() -> tuple[dict[str, str], list[Collection[str]]]:
    """Return the commands of ``generator-2018`` with their forms, and the commands of each of its templates."""
    generated = generate(read_generator_folder(DATA / "generator-2018").categories())
    forms = {each.command: each.form_text for each in generated.expansions}
    return forms, list(generated.commands_by_template.values())


def competition_pairs() -> tuple[dict[str, str], list[Collection[str]]]:
    """Return a sample of the competition's language, evenly by its templates."""
    (category,) = read_generator_folder(COMPETITION).categories()[:1]
    sample = Language([category]).sample(SampleRequest(SAMPLED, balance=Balance.LINES)).generated
    made: defaultdict[int, list[str]] = defaultdict(list)
    for each in sample.expansions:
        made[each.template_index].append(each.command)
    return {each.command: each.form_text for each in sample.expansions}, list(made.values())


def paraphrase_pairs() -> tuple[dict[str, str], list[Collection[str]]]:
    """Return what people said for the commands of 2018, with class tokens for the entities."""
    folder = DATA / "generator-2018"
    files = {each.name: each.read_bytes() for each in folder.iterdir() if each.is_file()}
    anonymizer = Anonymizer(read_ontology(files)[0])
    lines = (DATA / "walker2019" / "para" / "train.txt").read_text(encoding="utf-8").splitlines()
    texts = zip(lines[::2], lines[1::2], strict=True)
    pairs = {anonymizer.anonymize(said).command: form for said, form in texts}
    return {
        command: canonical_text(read_form(form))
        for command, form in pairs.items()
        if not any(word.startswith("<") and not word.endswith(">") for word in command.split())
    }, []


def shares_of(
    forms: Mapping[str, str], by_template: Sequence[Collection[str]], drawn: int, draws: int
) -> tuple[float, float, float]:
    """Return the shares of the commands that were not drawn: right, wrong, and made by the templates of those drawn."""
    known = {without_courtesy(command): form for command, form in forms.items()}
    counts = [0, 0, 0]
    for seed in range(draws):
        some = set(random.Random(seed).sample(sorted(forms), drawn))
        proposal = propose("\n".join(line_of(each, forms[each]) for each in sorted(some)))
        chart = TemplateChart([category_of(proposal)])
        made = set().union(*(each for each in by_template if some & set(each)))
        for command in forms.keys() - some:
            found = chart.parse(without_courtesy(command))
            form = found[0].form_text if found else ""
            counts[0] += form == known[without_courtesy(command)]
            counts[1] += bool(form) and form != known[without_courtesy(command)]
            counts[2] += command in made
    others = draws * (len(forms) - drawn)
    return counts[0] / others, counts[1] / others, counts[2] / others


def line_of(command: str, form_text: str) -> str:
    """Return the line of a command with class tokens: the n-th object is an entity "object n" of the class."""
    numbers: Counter[str] = Counter()

    def entity(token: str) -> str:
        numbers[token] += 1
        return f"{token[1:-1]} {numbers[token]}"

    words = [
        f"[{entity(word)}]({word[1:-1]})" if is_slot(word) else word for word in command.split()
    ]
    named, numbers = numbers, Counter()

    def fill(form: Form) -> Form:
        match form:
            case Constant(value=str(value)) if is_slot(value):
                name = entity(value)
                return Constant(
                    name if numbers[value] <= named[value] else f"{value[1:-1]} {named[value]}"
                )
            case Lambda(variable, type_, bodies):
                return Lambda(variable, type_, tuple(map(fill, bodies)))
            case Application(predicate, arguments):
                return Application(predicate, tuple(map(fill, arguments)))
            case _:
                return form

    return f"{' '.join(words)} = {to_corpus(fill(read_form(form_text)))}"


def without_courtesy(command: str) -> str:
    """Return a command with class tokens as examples have it."""
    marked = (f"[{word}]({word[1:-1]})" if is_slot(word) else word for word in command.split())
    parts = read_example(" ".join(marked)).parts
    return " ".join(part if isinstance(part, str) else part.text for part in parts)


def is_slot(word: str) -> bool:
    return word.startswith("<")


if __name__ == "__main__":
    main()
