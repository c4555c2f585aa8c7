"""The starter world as the language core reads it, once for all tests of it."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path

from annotations.exchange.predicates_file import read_predicates
from annotations.language.forms import Choice, Symbol, Wildcard
from annotations.language.grammar import Production
from annotations.language.templates import (
    Generated,
    GeneratorFolder,
    TaskCategory,
    generate,
    read_generator_folder,
)
from annotations.language.world import Ontology, Predicate
from tests.annotations.language.ontology_files import read_ontology_folder

STARTER = Path(__file__).parents[2] / "annotations" / "starter" / "household"


@cache
def folder() -> GeneratorFolder:
    return read_generator_folder(STARTER)


@cache
def categories() -> tuple[TaskCategory, ...]:
    return folder().categories()


@cache
def generated() -> Generated:
    return generate(categories())


@cache
def ontology() -> Ontology:
    return read_ontology_folder(STARTER)[0]


@cache
def predicates() -> dict[str, Predicate]:
    return read_predicates((STARTER / "predicates.json").read_bytes())


def productions() -> list[Production]:
    return [each for file in folder().grammars.files.values() for each in file.productions]


def wildcards() -> list[Wildcard]:
    """Every wildcard of the grammar, those inside notes too."""
    return [wildcard for each in productions() for wildcard in _wildcards(each.expansion)]


def _wildcards(symbols: tuple[Symbol, ...]) -> Iterator[Wildcard]:
    for symbol in symbols:
        if isinstance(symbol, Wildcard):
            yield symbol
            yield from _wildcards(symbol.meta)
        elif isinstance(symbol, Choice):
            for alternative in symbol.alternatives:
                yield from _wildcards(alternative)
