"""The worlds that come with the project, with what is learned from some of their commands."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random

from annotations.exchange.predicates_file import read_predicates
from annotations.language.forms import Constant, Form, children, read_form, with_part
from annotations.language.grounding import Anonymizer, deanonymize, ground, with_values
from annotations.language.grounding.role_evidence import wildcards_of
from annotations.language.plans import Fit, WordUse, fit
from annotations.language.templates import (
    TaskCategory,
    read_generator_folder,
    spread_derivations,
)
from annotations.language.world import Ontology, Predicate
from tests.annotations.language.ontology_files import read_ontology_folder

FOLDER = Path(__file__).parents[4] / "annotations" / "starter"


@dataclass(frozen=True)
class ShippedLanguage:
    ontology: Ontology
    categories: tuple[TaskCategory, ...]
    predicates: dict[str, Predicate]
    use: WordUse
    learned: frozenset[str]

    def derivations(self, most, random):
        for category in self.categories:
            yield from spread_derivations(category, most, random)

    def fit(self, utterance: str, form: str | Form, values: list[str] | tuple[()] = ()) -> Fit:
        form = read_form(form) if isinstance(form, str) else form
        heard = Anonymizer(self.ontology).anonymize(utterance)
        slots = with_values(deanonymize(form, heard, self.ontology).slots, values)
        return fit(form, slots, heard, self.use, self.ontology)

    def grounded(self, most: int, seed: int) -> Iterator[tuple[str, Form, tuple[str, ...]]]:
        """Yield commands that nothing was learned from, with drawn entities, their forms with class tokens, and the
        entities of these, in order."""
        random = Random(seed)
        for each in self.derivations(most, random):
            if each.anonymized_text in self.learned:
                continue
            grounded = ground(each.symbols, each.form, self.ontology, random)
            form, values = grounded.form, []
            for path, wildcard in wildcards_of(each.form):
                if wildcard.entity_class:
                    values.append(str(_part(grounded.form, path).value))
                    form = with_part(form, path, Constant(f"<{wildcard.entity_class}>"))
            yield grounded.text, form, tuple(values)


def _part(form: Form, path: tuple[int, ...]) -> Constant:
    for place in path:
        form = children(form)[place]
    assert isinstance(form, Constant)
    return form


@cache
def shipped(name: str) -> ShippedLanguage:
    folder = FOLDER / name
    ontology = read_ontology_folder(folder)[0]
    categories = read_generator_folder(folder).categories()
    predicates = read_predicates(
        (folder / "predicates.json").read_bytes(), classes=ontology.classes
    )
    drawn = [
        each for category in categories for each in spread_derivations(category, 25, Random(0))
    ]
    pairs = [(each.symbols, each.form) for each in drawn]
    use = WordUse.of(pairs, predicates, ontology.classes)
    learned = frozenset(each.anonymized_text for each in drawn)
    return ShippedLanguage(ontology, categories, predicates, use, learned)
