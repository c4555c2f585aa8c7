"""Which parser to train with what a split holds, and what to expect of it there.

A learned parser is the second part of what answers in a world: it is asked where the grammar oracle is silent. So its
figure on what people say counts first. Rules and figures are those of docs/design/parsers.md, "What to expect"; a
test holds the two together.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

from annotations.language.corpus import Overlap, together
from parser_service.parsers.conditions import GENERATED, Protocol
from parser_service.parsers.registry import parsers
from parser_service.parsers.registry_entry import Expectation

ENOUGH_PAIRS = 100  # to train more than the nearest neighbour
MANY_PARAPHRASES = 200  # "some hundred": from here on they teach more than glosses do
MANY_NEW_FORMS = 1 / 3  # of the validation forms: a parser has to write new ones itself
LEAST_RIGHT = 1 / 2  # below that a parser is wrong more often than right: a question is better


@dataclass(frozen=True, slots=True)
class TrainingMaterial:
    """What there is to learn from.

    ``generated`` and ``paraphrases`` count training pairs; paraphrases are all that the grammar did not
    write. ``overlaps`` says by source how much of the validation part training has; empty where there is none.
    ``trained`` are the parsers that have a run already, or will.
    """

    generated: int = 0
    paraphrases: int = 0
    has_ontology: bool = False
    overlaps: Mapping[str, Overlap] = field(default_factory=dict)
    trained: frozenset[str] = frozenset()

    @property
    def validation(self) -> Overlap:
        """The validation part, all sources together."""
        return together(self.overlaps.values())

    @property
    def said(self) -> Overlap:
        """What the validation part has of people; where it has nothing, generated commands tell which forms they will
        ask for."""
        said = together(each for source, each in self.overlaps.items() if source != GENERATED)
        return said if said.forms else Overlap(self.generated_forms.forms)

    @property
    def generated_forms(self) -> Overlap:
        return self.overlaps.get(GENERATED, Overlap())

    @property
    def asks_new_forms(self) -> bool:
        return self.validation.new_form_share >= MANY_NEW_FORMS

    @property
    def asks_new_commands(self) -> bool:
        return self.said.new_command_share >= MANY_NEW_FORMS


@dataclass(frozen=True, slots=True)
class Measured:
    """Exact match of a parser, fractions of 1, as docs/design/parsers.md has it with the commands that measured it.

    On what people say: ``said`` where it learned from paraphrases too, ``from_generated`` where from generated commands
    alone, ``other_commands`` where nobody rewrote the command before (None: not measured), ``new_forms`` where no
    training pair has the form. On generated commands: ``generated`` by the training pairs that their form has at
    least, empty where that was not measured.
    """

    said: float
    from_generated: float | None = None
    other_commands: float | None = None
    new_forms: float = 0.0
    generated: tuple[tuple[int, float], ...] = ()

    def of_people(self, paraphrases: int, said: Overlap) -> float:
        """Return the share to expect of what people say, where ``paraphrases`` were learned from.

        Between none and ``MANY_PARAPHRASES`` the figures pass into each other in proportion.
        """
        taught = min(1.0, paraphrases / MANY_PARAPHRASES)
        known = self.said
        if self.from_generated is not None:
            known = taught * self.said + (1 - taught) * self.from_generated
        others = known if self.other_commands is None else min(known, self.other_commands)
        new = said.examples_of_new_forms / said.examples if said.examples else 0.0
        rewritten = max(0.0, 1 - said.new_command_share)
        return (1 - new) * (rewritten * known + (1 - rewritten) * others) + new * self.new_forms

    def of_generated(self, generated: Overlap) -> float | None:
        """Return the share to expect of generated commands; None where it was not measured or none are asked."""
        if not self.generated or not generated.forms:
            return None
        least = [pairs for pairs, _ in self.generated]

        def right(taught: int) -> float:
            place = bisect_right(least, taught)
            return self.generated[place - 1][1] if place else self.new_forms

        return sum(form.asked * right(form.taught) for form in generated.forms) / generated.examples


MEASURED = {
    "knn": Measured(
        0.55, 0.41, 0.35, generated=((1, 0.07), (2, 0.14), (5, 0.29), (9, 0.64), (33, 0.44))
    ),
    "linear": Measured(
        0.80,
        0.53,
        0.61,
        generated=((1, 0.03), (2, 0.13), (3, 0.23), (5, 0.39), (9, 0.88), (33, 0.99)),
    ),
    "ranker": Measured(0.88, 0.71, 0.74, 0.61, ((1, 0.98),)),
    "seq2seq": Measured(0.75, 0.08),
    "seq2seq-minilm": Measured(0.79, new_forms=0.31),
    "seq2seq-glove": Measured(0.76, 0.23, new_forms=0.06),
}


def expectation_of(parser: str, material: TrainingMaterial) -> Expectation | None:
    """Return what to expect of a parser with this material; None where nobody has measured it."""
    expected = parsers()[parser].expected if parser in parsers() else None
    measured = MEASURED.get(parser)
    if expected is None or measured is None:
        return expected
    return replace(
        expected,
        generated=measured.of_generated(material.generated_forms),
        said=measured.of_people(material.paraphrases, material.said),
    )


@dataclass(frozen=True, slots=True)
class Recommendation:
    """A parser, the protocol to train it under, and a sentence that says why."""

    parser: str
    protocol: Protocol
    reason: str


def recommend(material: TrainingMaterial, lacking: Collection[str] = ()) -> Recommendation:
    """Return the parser to train next; ``lacking`` are those whose weights or server are not there.

    What learns within seconds comes first where it is expected to be right more often than not, then the ranker.
    """
    known = Protocol.DOMAIN if material.has_ontology else Protocol.STRICT
    pairs = material.generated + material.paraphrases
    if pairs < ENOUGH_PAIRS and "knn" not in material.trained and not material.asks_new_forms:
        reason = f"It needs no more than a few pairs; from {ENOUGH_PAIRS} on others are better."
        return Recommendation("knn", Protocol.STRICT, reason)
    is_fit = _is_fit("linear", material)
    if is_fit and "linear" not in material.trained:
        return Recommendation(
            "linear", known, "It learns within seconds. The form ranker comes next."
        )
    if "ranker" not in lacking:
        is_strict = material.paraphrases >= MANY_PARAPHRASES and not (
            material.asks_new_forms or material.asks_new_commands
        )
        return Recommendation(
            "ranker", Protocol.STRICT if is_strict else known, _why_ranker(material, is_fit)
        )
    if is_fit:
        return Recommendation(
            "linear", known, "What is expected to be right more often needs more."
        )
    return Recommendation(
        "seq2seq", Protocol.STRICT, "It writes forms that training does not have."
    )


def _is_fit(parser: str, material: TrainingMaterial) -> bool:
    """Return whether a parser can answer enough of the validation part's forms, and is expected to be right on half of
    what is asked, generated or said."""
    if material.asks_new_forms and not parsers()[parser].writes_new_forms:
        return False
    expected = expectation_of(parser, material)
    shares = (expected.generated, expected.said) if expected else ()
    return all(share is None or share >= LEAST_RIGHT for share in shares)


def _why_ranker(material: TrainingMaterial, is_linear_fit: bool) -> str:
    if material.asks_new_forms:
        return "A third or more of what validation asks for has a form that training does not have: it makes new ones."
    if not is_linear_fit:
        return "Training has few pairs of a form here, or few paraphrases. It needs fewer than the others."
    if material.asks_new_commands:
        return "This split asks for commands that nobody has rewritten. It is good at them."
    return "It is good at new wording."
