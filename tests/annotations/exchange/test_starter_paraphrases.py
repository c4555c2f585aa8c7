"""Each paraphrase of the starter world rewrites a command that grounding can really produce."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from random import Random
from typing import NamedTuple

from annotations.language.forms import Constant, Text, canonical_text, read_form, walk
from annotations.language.grounding import Anonymizer, ground
from annotations.language.grounding.grounding import Grounded
from annotations.language.templates import Derivation, TemplateExpander
from annotations.language.templates.filling import fill_anonymized
from annotations.language.texts.errors import LanguageError
from annotations.language.world import Entity, Ontology, check_form
from tests.annotations.starter import STARTER, categories, generated, ontology, predicates

SEEDS = range(30)  # enough to draw two entities in the order of the prompt, 1 in 2 at each try


class Record(NamedTuple):
    utterance: str
    prompt: str
    form: str


@cache
def records() -> tuple[Record, ...]:
    lines = (STARTER / "paraphrases.txt").read_text(encoding="utf-8").splitlines()
    assert len(lines) % 3 == 0
    return tuple(Record(*lines[start : start + 3]) for start in range(0, len(lines), 3))


@cache
def derivations() -> tuple[tuple[re.Pattern[str], Derivation], ...]:
    """Every command with its wildcards, notes left out, behind the shape of its words."""
    shapes = []
    for category in categories():
        expander = TemplateExpander(category.grammar)
        for template in category.templates:
            for each in expander.derivations(template):
                spoken = tuple(
                    symbol if isinstance(symbol, Text) else replace(symbol, meta=())
                    for symbol in each.symbols
                    if isinstance(symbol, Text) or symbol.kind != "void"
                )
                shapes.append((shape(spoken), replace(each, symbols=spoken)))
    return tuple(shapes)


def shape(symbols) -> re.Pattern[str]:
    words = (re.escape(each.value) if isinstance(each, Text) else ".+" for each in symbols)
    return re.compile(" ".join(words))


def mentioned(prompt: str) -> Ontology:
    """The part of the ontology that a prompt can be about: grounding can draw nothing else."""
    return Ontology(tuple(each for each in ontology().entities if is_mentioned(each, prompt)))


def is_mentioned(entity: Entity, prompt: str) -> bool:
    category = entity.text if entity.entity_class == "category" else entity.attribute("category")
    kind = ontology().singular(category or "category")  # what {object?} says
    return entity.entity_class == "question" or any(
        f" {words} " in f" {prompt} " for words in (entity.text, kind)
    )


def groundings(prompt: str) -> Iterator[tuple[Derivation, Grounded]]:
    """Derivations that grounding turns into the prompt, word for word."""
    part = mentioned(prompt)
    for pattern, derivation in derivations():
        if not pattern.fullmatch(prompt):
            continue
        for seed in SEEDS:
            try:
                made = ground(derivation.symbols, derivation.form, part, Random(seed))
            except LanguageError:
                break  # these entities do not satisfy its wildcards
            if made.text == prompt:
                yield derivation, made
                break


@cache
def produced() -> dict[str, list[tuple[Derivation, Grounded]]]:
    prompts = dict.fromkeys(record.prompt for record in records())
    return {prompt: list(groundings(prompt)) for prompt in prompts}


def test_grounding_can_produce_each_prompt_with_the_form_of_its_paraphrases():
    for record in records():
        forms = {canonical_text(made.form) for _, made in produced()[record.prompt]}
        assert forms == {record.form}, record


def test_the_anonymized_form_of_a_prompt_is_that_of_its_anonymized_command():
    annotated = {each.command: each.form_text for each in generated().expansions}
    for prompt, derived in produced().items():
        for derivation, _ in derived:
            assert annotated[derivation.anonymized_text] == anonymized_form(derivation), prompt


def anonymized_form(derivation: Derivation) -> str:
    return canonical_text(fill_anonymized(derivation.form, {}))


def test_forms_are_canonical_and_fit_the_predicates():
    for text in {record.form for record in records()}:
        form = read_form(text)
        assert canonical_text(form) == text
        assert check_form(form, predicates()) == []


def test_every_form_is_said_in_at_least_four_ways():
    said = ({anonymized_form(d) for d, _ in produced()[record.prompt]} for record in records())
    ways = Counter(form for forms in said for form in forms)
    assert set(ways) == {each.form_text for each in generated().expansions}
    assert min(ways.values()) >= 4


def test_no_utterance_is_written_twice_or_repeats_its_prompt():
    said = Counter(record.utterance.lower() for record in records())
    assert said.most_common(1)[0][1] == 1
    assert not [record for record in records() if record.utterance.lower() == record.prompt]


def test_an_anonymized_prompt_is_its_command():
    anonymizer = Anonymizer(ontology())
    for prompt, derived in produced().items():
        commands = {derivation.anonymized_text for derivation, _ in derived}
        assert commands == {anonymizer.anonymize(prompt).command}


def test_an_utterance_names_what_its_form_names_and_nothing_else():
    anonymizer = Anonymizer(ontology())
    for record in records():
        spans = anonymizer.anonymize(record.utterance).spans
        if record.form != "UNKNOWN":
            assert {span.value for span in spans} == texts(record.form), record


def texts(form: str) -> set[str]:
    values = (each.value for each in walk(read_form(form)) if isinstance(each, Constant))
    return {value for value in values if isinstance(value, str)}
