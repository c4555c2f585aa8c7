"""The forms that a ranker chooses from, and its examples of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from random import Random
from typing import Any, Self

from annotations.language.corpus import Rewording
from annotations.language.forms import DEFAULT_CLASSES, EntityClasses, read_or_none
from annotations.language.grounding import Anonymizer
from annotations.language.plans import other_requests
from annotations.language.world import Ontology, Predicate, gloss, infer_signatures, pattern_of_name
from parser_service.parsers.conditions import GENERATED
from parser_service.parsers.generation import generate_candidates
from parser_service.parsers.interface import REFUSAL, TRAINING, Check, Knowledge, Pair, keep_going
from parser_service.parsers.spreading import spread

MOST_EXAMPLES = 20_000
LEAST_PARAPHRASES = 4  # of a form; fewer do not show how else people say it
MOST_SUPPORT = 4  # kinds of step, above which more of them say no more


@dataclass(frozen=True, slots=True)
class RankedExample:
    """An utterance and the number of its form; ``pattern`` is the utterance with class tokens for
    known entities."""

    utterance: str
    form: int
    pattern: str


@dataclass(frozen=True, slots=True)
class RankedForms:
    """Known forms first, then new ones; each with its gloss.

    The last ``requests`` of the known ones are no forms but kinds of requests that are no command; they are
    answered with UNKNOWN.

    ``support`` is, for each new form, the number of kinds of step that arrive at it. ``examples`` has
    for each example the number of its form: known forms have examples, and under *grammar* all have.
    ``origins`` names for each new form the step that made it; a parser that was saved without them has
    none.
    """

    forms: tuple[str, ...]
    glosses: tuple[str, ...]
    known: int
    support: tuple[int, ...]
    examples: tuple[int, ...]
    origins: tuple[str, ...] = ()
    requests: int = 0

    @classmethod
    def read(cls, values: Mapping[str, Any]) -> Self:
        """Read what ``to_json`` returned."""
        return cls(
            tuple(values["forms"]),
            tuple(values["glosses"]),
            values["known"],
            tuple(values["support"]),
            tuple(values["examples"]),
            tuple(values.get("origins", ())),
            values.get("requests", 0),
        )

    @property
    def refused(self) -> slice:
        """The numbers of the requests that are no command."""
        return slice(self.known - self.requests, self.known)

    def origin(self, number: int) -> str:
        """Return where form ``number`` comes from; empty where it is not known."""
        if number in range(self.known)[self.refused]:
            return REFUSAL
        if number < self.known:
            return TRAINING
        return self.origins[number - self.known] if self.origins else ""

    def to_json(self) -> dict[str, Any]:
        """Return it as a mapping that is ready for JSON."""
        return asdict(self)


def collect(
    pairs: Sequence[Pair],
    knowledge: Knowledge,
    is_open: bool,
    check: Check = keep_going,
    rewordings: int = 0,
    seed: int = 0,
) -> tuple[RankedForms, list[RankedExample], str]:
    """Return the forms to choose from, the examples to learn from, and a line for the log.

    Where the grammar is known, its commands are examples as well; a command that is the utterance of a
    pair keeps the form of the pair. There are at most ``MOST_EXAMPLES``, or one of each form. Each form with fewer
    than ``LEAST_PARAPHRASES`` has ``rewordings`` more examples, where the predicates are declared.
    """
    generated = generate_candidates(pairs, knowledge, is_open, check)
    requests = other_requests(knowledge.predicates) if knowledge.predicates is not None else ()
    known = (*generated.training, *(each.gloss for each in requests))
    forms = (*known, *(each.form for each in generated.new))
    number = {form: at for at, form in enumerate(forms)}
    meant = [(pair.utterance, pair.form) for pair in pairs]
    said = {utterance for utterance, _ in meant}
    meant += [
        (command, form)
        for form, commands in generated.commands.items()
        for command in commands
        if command not in said
    ]
    kept = spread(meant, max(MOST_EXAMPLES, len(forms)), lambda each: each[1])
    kept += reword(pairs, knowledge, rewordings, seed, check)
    random = Random(f"{seed} other requests")
    commands = sorted(said)
    kept += [(text, each.gloss) for each in requests for text in each.examples(commands, random)]
    ontology = knowledge.ontology or Ontology(())
    anonymizer = Anonymizer(ontology)
    examples = []
    for utterance, form in kept:
        check()
        pattern = anonymizer.anonymize(utterance).text
        examples.append(RankedExample(utterance, number[form], pattern))
    ranked = RankedForms(
        forms,
        tuple(glosses(forms, knowledge.predicates, check, ontology.classes)),
        len(known),
        tuple(min(each.support, MOST_SUPPORT) for each in generated.new),
        tuple(each.form for each in examples),
        tuple(each.main_step for each in generated.new),
        len(requests),
    )
    line = str(generated)
    if len(meant) > max(MOST_EXAMPLES, len(forms)):
        line += f" Of {len(meant):,} pairs, {MOST_EXAMPLES:,} are read, of all forms alike."
    return ranked, examples, line


def reword(
    pairs: Sequence[Pair], knowledge: Knowledge, number: int, seed: int, check: Check = keep_going
) -> list[tuple[str, str]]:
    """Return ``number`` rewordings of each form of ``pairs`` with fewer than ``LEAST_PARAPHRASES``, each with its form.

    They stand in for people: what is learned from generated commands alone is not how people speak. There are none
    where the predicates are not declared.
    """
    if knowledge.predicates is None or not number:
        return []
    classes = knowledge.ontology.classes if knowledge.ontology else DEFAULT_CLASSES
    rewording = Rewording(knowledge.predicates, classes)
    paraphrases = Counter(pair.form for pair in pairs if pair.source != GENERATED)
    others = sorted({pair.form for pair in pairs if paraphrases[pair.form] < LEAST_PARAPHRASES})
    said: dict[tuple[str, str], None] = {}
    for form in others:
        check()
        if read_or_none(form) is None:
            continue
        random = Random(f"{seed} rewordings of {form}")
        said |= {(rewording.say(form, random), form): None for _ in range(number)}
    return list(said)


def glosses(
    forms: Sequence[str],
    predicates: Mapping[str, Predicate] | None,
    check: Check = keep_going,
    classes: EntityClasses = DEFAULT_CLASSES,
) -> list[str]:
    """Return a short English sentence for each form; a text that is not a form is its own gloss.

    Declared ``predicates`` have glosses (*domain*). Without them (*strict*) a predicate is called by
    the words of its name, even where this program knows better.
    """
    read = [read_or_none(form) for form in forms]
    if predicates is None:
        inferred = infer_signatures(form for form in read if form is not None)
        known: Mapping[str, Predicate] = {
            name: replace(each, gloss=pattern_of_name(name, each.is_action, each.signatures))
            for name, each in inferred.items()
        }
    else:
        known = predicates
    texts = []
    for text, form in zip(forms, read, strict=True):
        check()
        texts.append(text if form is None else gloss(form, known, classes))
    return texts
