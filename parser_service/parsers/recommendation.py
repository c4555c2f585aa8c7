"""Which parser to train with what a world has, and what to expect of it.

The rules and the figures are those of docs/design/parsers.md, "Which row to take"; a test holds the two together.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

from annotations.language.corpus import Criterion
from parser_service.parsers.conditions import Protocol

ENOUGH_PAIRS = 100  # to train more than the nearest neighbour
MANY_PARAPHRASES = 200  # "some hundred": from here on they teach more than glosses do


@dataclass(frozen=True, slots=True)
class TrainingMaterial:
    """What there is to learn from.

    ``generated`` and ``paraphrases`` count training pairs; paraphrases are all that the grammar did not
    write. ``trained`` are the parsers that have a run already, or will.
    """

    generated: int = 0
    paraphrases: int = 0
    has_ontology: bool = False
    criterion: Criterion = Criterion.COMMAND
    trained: frozenset[str] = frozenset()

    @property
    def asks_new_forms(self) -> bool:
        return self.criterion == Criterion.LOGICAL_FORM

    @property
    def asks_new_commands(self) -> bool:
        return self.criterion == Criterion.SOURCE_COMMAND


@dataclass(frozen=True, slots=True)
class Recommendation:
    """A parser, the protocol to train it under, and a sentence that says why."""

    parser: str
    protocol: Protocol
    reason: str


def recommend(material: TrainingMaterial, lacking: Collection[str] = ()) -> Recommendation:
    """Return the parser to train next; ``lacking`` are those whose weights or server are not there.

    What answers within seconds comes first, then the most accurate one.
    """
    known = Protocol.DOMAIN if material.has_ontology else Protocol.STRICT
    if material.asks_new_forms:
        if "ranker" in lacking:
            return Recommendation(
                "seq2seq",
                Protocol.STRICT,
                "This split asks for forms that training has not: it writes new ones.",
            )
        return Recommendation(
            "ranker", known, "This split asks for forms that training has not: it makes new ones."
        )
    pairs = material.generated + material.paraphrases
    if pairs < ENOUGH_PAIRS and "knn" not in material.trained:
        return Recommendation(
            "knn",
            Protocol.STRICT,
            f"It needs no more than a few pairs; from {ENOUGH_PAIRS} on others are better.",
        )
    if "linear" not in material.trained:
        return Recommendation(
            "linear", known, "Good within seconds. The most accurate parser comes next."
        )
    if "ranker" in lacking:
        return Recommendation("linear", known, "The most accurate parser that lacks nothing here.")
    if material.paraphrases < MANY_PARAPHRASES:
        reason = "The most accurate one. Glosses of the predicates stand in for the paraphrases that are few."
        return Recommendation("ranker", known, reason)
    if material.asks_new_commands:
        reason = "The most accurate one; this split asks for commands that nobody has rewritten."
        return Recommendation("ranker", known, reason)
    return Recommendation("ranker", Protocol.STRICT, "The most accurate one.")


@dataclass(frozen=True, slots=True)
class Expectation:
    """What was measured of a parser elsewhere: exact match, how long a training takes, the memory it needs."""

    accuracy: str
    time: str = ""
    memory: str = ""


RANKER_TIME, RANKER_MEMORY = "minutes on 2 cores", "2 GB"
GLOVE = Expectation("76 % of paraphrases", "minutes on 1 core", "0.4 GB")
EXPECTED = {
    "grammar-oracle": Expectation(
        "100 % of generated commands; 5 % of what people say", "no training"
    ),
    "knn": Expectation(
        "69 % of generated commands; 52 to 55 % of paraphrases; no new form", "a second"
    ),
    "linear": Expectation(
        "81 % of the starter world's paraphrases; 78 to 80 % of the published ones; no new form",
        "seconds",
        "0.5 GB",
    ),
    "seq2seq": Expectation("72 to 75 % of paraphrases", "minutes on 1 core", "0.4 GB"),
    "seq2seq-minilm": Expectation("76 to 82 % of paraphrases", "a minute on 1 core", "0.6 GB"),
    "seq2seq-glove": GLOVE,
    "t5": Expectation("that of the weights you bring", "depends on them", "8 GB or a GPU"),
    "llm": Expectation("that of the model", "no training; seconds an answer"),
}
# By form; the first two never answer with another form, "paper" is where nobody has measured it here.
ON_NEW_FORMS = {
    "knn": "0 % on unseen forms",
    "linear": "0 % on unseen forms",
    "seq2seq": "0 % on unseen forms in the paper",
    "seq2seq-minilm": "31 % on unseen forms",
    "seq2seq-glove": "6 % on unseen forms in the paper",
}
RANKER = {
    "few paraphrases": "71 % of paraphrases",
    "many paraphrases": "86 to 89 % of paraphrases; 92 % of paraphrases and generated commands together",
    "new commands": "74 % of paraphrases of other commands",
    "new forms": "61 % on unseen and 85 % on known forms",
}


def expectation_of(parser: str, material: TrainingMaterial) -> Expectation | None:
    """Return what to expect of a parser with this material; None where nobody has measured it."""
    if parser != "ranker":
        if material.asks_new_forms and parser in ON_NEW_FORMS:
            return replace(EXPECTED[parser], accuracy=ON_NEW_FORMS[parser])
        return EXPECTED.get(parser)
    if material.asks_new_forms:
        case = "new forms"
    elif material.paraphrases < MANY_PARAPHRASES:
        case = "few paraphrases"
    else:
        case = "new commands" if material.asks_new_commands else "many paraphrases"
    return Expectation(RANKER[case], RANKER_TIME, RANKER_MEMORY)
