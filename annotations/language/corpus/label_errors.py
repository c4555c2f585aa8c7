"""Find labels that look wrong: those that disagree with their command, with a parser, or with their own words."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import lru_cache
from itertools import permutations
from random import Random

from annotations.language.forms import (
    Application,
    Form,
    Lambda,
    Unknown,
    canonical_text,
    equivalent,
    flatten_conjunctions,
    predicates,
    read_or_none,
)
from annotations.language.texts import (
    CONTRASTS,
    NEAR_SYNONYMS,
    NEGATIONS,
    PREDICATE_WORDS,
    Refusal,
)

WEAK = 0.2  # a finding with this score or less is no further reason
OPPOSITE, NEARLY_THE_SAME = 1.0, 0.5  # how strong a word is as evidence
NEGATED_WITHIN = 3  # words between a negation and what it negates, at most
LEAST_FOLDS, MOST_FOLDS = 2, 20


class Reason(StrEnum):
    """What a label disagrees with, the one whose suggestion is most often right first."""

    COMMAND = "command"
    WORD = "word"
    PARSER = "parser"


@dataclass(frozen=True, slots=True)
class LabelledPair:
    """An utterance and its label, with class tokens or without.

    ``key`` tells the pairs of one audit apart. ``form`` is canonical corpus text. ``source_command`` is the
    command that the utterance rewrites and ``command_form`` the canonical form of that command; each
    is empty where it is not known.
    """

    key: str
    utterance: str
    form: str
    source_command: str = ""
    command_form: str = ""


@dataclass(frozen=True, slots=True)
class Finding:
    """One reason to doubt the label of ``pair``. ``score`` is how strong it is, above 0 and up to 1."""

    pair: LabelledPair
    reason: Reason
    sentence: str
    suggested_form: str
    score: float


@dataclass(frozen=True, slots=True)
class Suspect:
    """A pair and everything that speaks against its label, in the order of ``Reason``."""

    pair: LabelledPair
    findings: tuple[Finding, ...]

    @property
    def reasons(self) -> frozenset[Reason]:
        return frozenset(finding.reason for finding in self.findings)

    @property
    def best_scores(self) -> dict[Reason, float]:
        """Reason → the score of its strongest finding, in the order of ``Reason``."""
        return {
            reason: max(each.score for each in self.findings if each.reason is reason)
            for reason in Reason
            if reason in self.reasons
        }

    @property
    def score(self) -> float:
        """The sum of the best score of each reason."""
        return sum(self.best_scores.values())

    @property
    def strong_reasons(self) -> int:
        """How many reasons have a finding that is not weak."""
        return sum(score > WEAK for score in self.best_scores.values())

    @property
    def suggested_form(self) -> str:
        """The form that most findings suggest; of several such forms, that of the first finding."""
        forms = [finding.suggested_form for finding in self.findings]
        return max(forms, key=forms.count)


def rank(findings: Iterable[Finding]) -> tuple[Suspect, ...]:
    """Return one suspect per pair: several strong reasons first, then the higher score, then the key."""
    by_pair: dict[LabelledPair, list[Finding]] = defaultdict(list)
    for finding in findings:
        by_pair[finding.pair].append(finding)
    suspects = [
        Suspect(pair, tuple(sorted(some, key=lambda each: (_ORDER[each.reason], -each.score))))
        for pair, some in by_pair.items()
    ]
    return tuple(
        sorted(suspects, key=lambda each: (-each.strong_reasons, -each.score, each.pair.key))
    )


_ORDER = {reason: place for place, reason in enumerate(Reason)}


@dataclass(frozen=True, slots=True)
class Contradiction:
    """``word`` of a text says ``said``, where the form has ``predicate``; ``strength`` is 0 to 1."""

    predicate: str
    said: str
    word: str
    strength: float

    def corrected(self, form: Form) -> Form:
        """Return the form with the predicate that the text says."""
        if isinstance(form, Lambda):
            return replace(form, bodies=tuple(map(self.corrected, form.bodies)))
        if isinstance(form, Application):
            name = self.said if form.predicate == self.predicate else form.predicate
            return Application(name, tuple(map(self.corrected, form.arguments)))
        return form


def contradictions(text: str, form: Form) -> Iterator[Contradiction]:
    """Yield what the words of ``text`` contradict, each predicate of the form once at most.

    Nothing is said about a predicate whose own words are in the text too, nor by a word after a
    negation, nor by one that another predicate of the form explains.
    """
    used = set(predicates(form))
    contradicted = set()
    for predicate, other in _CONTRASTING:
        if predicate not in used or other in used or predicate in contradicted:
            continue
        match = _WORDS[other].search(text)
        if match is None or _WORDS[predicate].search(text):
            continue
        before = text[: match.start()].casefold().replace("’", "'")
        if NEGATIONS.isdisjoint(re.findall(r"[\w'’]+", before)[-NEGATED_WITHIN:]):
            contradicted.add(predicate)
            strength = NEARLY_THE_SAME if {predicate, other} in _ALIKE else OPPOSITE
            yield Contradiction(predicate, other, match[0], strength)


_ALIKE = [set(names) for names in NEAR_SYNONYMS]
_CONTRASTING = [pair for group in CONTRASTS for pair in permutations(group, 2)]
_WORDS = {
    name: re.compile(rf"\b(?:{'|'.join(map(re.escape, words))})\b", re.IGNORECASE)
    for name, words in PREDICATE_WORDS.items()
}


@dataclass(frozen=True, slots=True)
class ScoredForm:
    """A canonical form and its score, which can be compared with those of the same parser."""

    form: str
    score: float


def check_commands(pairs: Iterable[LabelledPair]) -> Iterator[Finding]:
    """Yield the pairs whose label is not the form of the command behind them.

    It is weak evidence where both mean the same, or where that form is UNKNOWN.
    """
    for pair in pairs:
        if pair.command_form and pair.command_form != pair.form:
            if isinstance(_read(pair.command_form), Unknown):
                what, score = "has no form (UNKNOWN)", WEAK
            elif _mean_the_same(pair.form, pair.command_form):
                what, score = "writes the same meaning in another way", WEAK
            else:
                what, score = "has another form", 1.0
            sentence = f"The command behind it, “{pair.source_command}”, {what}."
            yield Finding(pair, Reason.COMMAND, sentence, pair.command_form, score)


def check_answers(
    pairs: Iterable[LabelledPair], answers: Mapping[str, Sequence[ScoredForm]], parser: str
) -> list[Finding]:
    """Return the pairs for which the parser called ``parser`` prefers another form to the label.

    Args:
        answers: the candidates of the parser for a pair, best first, by the key of the pair. The
            parser must not have seen the pair. A pair without candidates is passed over, and so is one
            whose best candidate means the same as the label.

    The score is the share of these findings whose best form is ahead of the label by no more than
    this one's; a label that is not among the candidates is behind by the whole range of the scores.
    """
    ahead: list[tuple[LabelledPair, ScoredForm, float]] = []
    for pair in pairs:
        if not (candidates := answers.get(pair.key)):
            continue
        of_label = [each.score for each in candidates if each.form == pair.form]
        lowest = min(candidates[-1].score, 0.0)
        top = candidates[0]
        lead = top.score - max(of_label, default=lowest)
        if lead > 0 and not _mean_the_same(pair.form, top.form):
            ahead.append((pair, top, lead))
    ordered = sorted(lead for _, _, lead in ahead)
    sentence = f"{parser}, which did not see it, answers with another form."
    return [
        Finding(pair, Reason.PARSER, sentence, top.form, bisect_right(ordered, lead) / len(ordered))
        for pair, top, lead in ahead
    ]


def check_words(pairs: Iterable[LabelledPair]) -> Iterator[Finding]:
    """Yield the pairs with a word, or a word of the command behind them, that contradicts the label.

    A label that cannot be read is passed over.
    """
    for pair in pairs:
        form = _read(pair.form)
        if form is None:
            continue
        for where, text in (("It", pair.utterance), ("The command behind it", pair.source_command)):
            for contradiction in contradictions(text, form):
                word, predicate = contradiction.word, contradiction.predicate
                sentence = f"{where} says “{word}”, the form says “{predicate}”."
                suggested = canonical_text(contradiction.corrected(form))
                yield Finding(pair, Reason.WORD, sentence, suggested, contradiction.strength)


@lru_cache(maxsize=4096)
def _mean_the_same(first: str, second: str) -> bool:
    """Return whether two texts are one form but for the order and the notation of conjunctions."""
    one, other = _read(first), _read(second)
    return (
        one is not None
        and other is not None
        and equivalent(flatten_conjunctions(one), flatten_conjunctions(other))
    )


_read = lru_cache(maxsize=4096)(read_or_none)


def source_key(pair: LabelledPair) -> str:
    """Return what pairs share that belong in one fold: the source command, or else the utterance."""
    return " ".join((pair.source_command or pair.utterance).casefold().split())


def assign_folds(pairs: Iterable[LabelledPair], count: int, seed: int = 0) -> dict[str, int]:
    """Return the fold, 0 to ``count`` - 1, of each ``source_key``. Folds have about as many pairs each.

    The order of the pairs has no effect.

    Raises:
        Refusal: ``count`` is out of range or there are fewer keys than folds.
    """
    if not LEAST_FOLDS <= count <= MOST_FOLDS:
        said = f"The number of folds is {count}; it has to be {LEAST_FOLDS} to {MOST_FOLDS}."
        raise Refusal(said, "folds_out_of_range")
    sizes = Counter(map(source_key, pairs))
    if len(sizes) < count:
        said = f"There are pairs of {len(sizes)} source commands, too few for {count} folds."
        raise Refusal(said, "too_few_commands")
    shuffled = sorted(sizes)
    Random(seed).shuffle(shuffled)
    filled = [0] * count
    folds = {}
    for key in sorted(shuffled, key=lambda each: -sizes[each]):
        fold = filled.index(min(filled))
        folds[key] = fold
        filled[fold] += sizes[key]
    return folds
