"""Pairs that a training leaves out at first, to learn from them when a form is new."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from random import Random

from annotations.language.forms import Application, read_form
from annotations.language.texts import LanguageError
from parser_service.parsers.conditions import GENERATED
from parser_service.parsers.interface import Pair
from parser_service.parsers.spreading import spread
from parser_service.parsers.words import words

LEAST_FORMS = 5  # with fewer, nothing is held out
NEW_SHARE = 0.12  # of the forms
LEAST_NEW, MOST_NEW = 2, 40  # forms
KNOWN_SHARE = 0.6  # of the other forms, of which some utterances are held out
MOST_KNOWN = 200  # forms
LEAST_PAIRS = 4  # of a form of which some are held out
PART = 5  # one in so many utterances of such a form
MOST_ASKED = 300  # utterances of each kind


@dataclass(frozen=True, slots=True)
class HeldOut:
    """``train`` is what is left: it has no form of ``new``, and all forms of ``known``."""

    train: tuple[Pair, ...]
    new: tuple[Pair, ...]
    known: tuple[Pair, ...]


def hold_out(pairs: Sequence[Pair], seed: int) -> HeldOut | None:
    """Hold out an eighth of the forms, of all actions alike, and some utterances of other forms.

    Those are an utterance and what is most like it among the pairs of its form, by their words: a
    person who says something else than all training pairs is who the decision is made for. Returns
    None where there are too few forms or pairs.
    """
    by_form: defaultdict[str, list[Pair]] = defaultdict(list)
    for pair in pairs:
        by_form[pair.form].append(pair)
    if len(by_form) < LEAST_FORMS:
        return None
    random = Random(f"held out {seed}")
    new = set(_draw_forms(sorted(by_form), random))
    known = _draw_known({form: by_form[form] for form in sorted(by_form.keys() - new)}, random)
    if not known:
        return None
    left_out = set(map(id, known))
    train = (pair for pair in pairs if pair.form not in new and id(pair) not in left_out)
    of_new = [pair for pair in pairs if pair.form in new]
    some = (tuple(spread(each, MOST_ASKED, lambda pair: pair.form)) for each in (of_new, known))
    return HeldOut(tuple(train), *some)


def _draw_forms(forms: Sequence[str], random: Random) -> list[str]:
    """Draw forms of each action in proportion; of an action with a single form none, unless all are such."""
    by_action: defaultdict[str, list[str]] = defaultdict(list)
    for form in forms:
        by_action[_action(form)].append(form)
    several = [alike for alike in by_action.values() if len(alike) > 1]
    ranked = sorted(
        ((turn + random.random()) / len(alike), form)
        for alike in several or by_action.values()
        for turn, form in enumerate(random.sample(alike, len(alike)))
    )
    number = min(max(LEAST_NEW, round(NEW_SHARE * len(forms))), MOST_NEW)
    return [form for _, form in ranked[:number]]


def _draw_known(by_form: dict[str, list[Pair]], random: Random) -> list[Pair]:
    """Draw utterances of some of the forms, each with those of its form that share most words with it."""
    many = [alike for alike in by_form.values() if len(alike) >= LEAST_PAIRS]
    number = min(MOST_KNOWN, -int(-len(many) * KNOWN_SHARE))
    drawn: list[Pair] = []
    for alike in random.sample(many, number):
        paraphrases = [pair for pair in alike if pair.source != GENERATED]
        first = random.choice(paraphrases or alike)
        nearest = sorted(alike, key=lambda pair: -_likeness(pair, first))
        drawn += nearest[: max(1, len(alike) // PART)]
    return drawn


def _action(text: str) -> str:
    """Return the outermost predicate of a form; the text itself where it is no application."""
    try:
        form = read_form(text)
    except LanguageError:
        return text
    return str(form.predicate) if isinstance(form, Application) else text


def _likeness(pair: Pair, other: Pair) -> float:
    """Return the share of common words (Jaccard 1912)."""
    mine, its = set(words(pair.utterance)), set(words(other.utterance))
    return len(mine & its) / (len(mine | its) or 1)
