"""Commands that a template makes, with entities of the world in them."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from random import Random

from annotations.checking.template_check import Checked
from annotations.language.errors import LanguageError
from annotations.language.grammar import CHECK_STEPS, Budget
from annotations.language.grounding import ground
from annotations.language.predicates import gloss
from annotations.language.templates import Derivation
from annotations.models import World
from annotations.rows.from_rows import ontology_of, predicates_of

SHOWN_SAMPLES = 5
MOST_DERIVATIONS = 500  # that samples are drawn from
LARGEST_SEED = 2**31


@dataclass(frozen=True, slots=True)
class Sample:
    """A command as somebody would say it, and the English sentence of its form."""

    text: str
    gloss: str


@dataclass(frozen=True, slots=True)
class Samples:
    """Some samples, the seed that gives others, and what the ontology lacks for more of them."""

    rows: tuple[Sample, ...]
    next_seed: int
    missing: str = ""


def samples_of(world: World, checked: Checked, seed: int = 0) -> Samples:
    """Draw commands of a template with entities in the place of its wildcards.

    The same template, ontology and ``seed`` give the same samples.
    """
    random, missing = Random(seed), ""
    ontology, declared = ontology_of(world), predicates_of(world)
    rows: dict[str, Sample] = {}
    derivations = _derivations(checked)
    for derivation in random.choices(derivations, k=3 * SHOWN_SAMPLES) if derivations else ():
        try:
            grounded = ground(derivation.symbols, derivation.form, ontology, random)
        except LanguageError as error:
            missing = error.message
            continue
        rows.setdefault(grounded.text, Sample(grounded.text, gloss(grounded.form, declared)))
    shown = tuple(islice(rows.values(), SHOWN_SAMPLES))
    return Samples(shown, (seed + 1) % LARGEST_SEED, missing)


def _derivations(checked: Checked) -> list[Derivation]:
    """Return the first derivations of the template, as many as the budget of a check allows."""
    if checked.template is None or checked.checker is None or checked.has_errors:
        return []
    stream = checked.checker.expander.derivations(checked.template, budget=Budget(CHECK_STEPS))
    derivations: list[Derivation] = []
    with suppress(LanguageError):  # when the budget is spent, those before it will do
        derivations.extend(islice(stream, MOST_DERIVATIONS))
    return derivations
