"""The interface of a parser (fit, predict, save and load) and the values that it passes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

from parser_service.parsers.conditions import Protocol

if TYPE_CHECKING:
    from annotations.language.grounding import HeardChange
    from annotations.language.templates import TaskCategory
    from annotations.language.world import Ontology, Predicate

TRAINING = "training"  # the origin of a form that a training pair has
UNKNOWN = "UNKNOWN"  # the answer where no form fits
REFUSAL = "refusal"  # its origin where no form is probable enough

Check = Callable[[], None]
"""Called between batches; raises ``Cancelled`` when the work has to stop."""


@dataclass(frozen=True, slots=True)
class Pair:
    """One example. ``form`` is canonical corpus text."""

    utterance: str
    form: str
    source: str = "generated"  # or "paraphrased"
    task_category: str = ""


class ScoreKind(StrEnum):
    """What the score of an answer is. A score that only orders the answers is none of these."""

    PROBABILITY = "probability"
    LOG_PROBABILITY = "log_probability"
    SIMILARITY = "similarity"


@dataclass(frozen=True, slots=True)
class Candidate:
    """One answer.

    ``form`` is canonical corpus text, or the text that the parser wrote where that is not a form;
    ``score`` orders the candidates of one utterance and can be compared within one parser only.

    ``origin`` names what gave the parser this form: the pairs it learned from (``TRAINING``), a step of
    ``candidates``, or what the parser documents; empty where it does not tell. ``parts`` are the
    numbers that the score is made of, by name. ``is_cut`` says that the utterance is longer than the parser
    reads. ``values`` are the entities of the class tokens of the form, in order, where the parser knows which
    words it took for which (None for a token of which it does not). ``heard`` is what the parser heard otherwise than
    it was said, with its places in the utterance as ``normalise_line`` gives it. None of them tells two answers apart.
    """

    form: str
    score: float
    origin: str = field(default="", compare=False)
    parts: Mapping[str, float] = field(default_factory=dict, compare=False)
    is_cut: bool = field(default=False, compare=False)
    values: tuple[str | None, ...] = field(default=(), compare=False)
    heard: tuple[HeardChange, ...] = field(default=(), compare=False)


def refuse(ranked: Sequence[Candidate], score: float) -> list[Candidate]:
    """Return UNKNOWN with ``score``, then ``ranked`` without its own UNKNOWN."""
    others = [each for each in ranked if each.form != UNKNOWN]
    return [Candidate(UNKNOWN, score, REFUSAL), *others]


@dataclass(frozen=True, slots=True)
class Knowledge:
    """What a parser may know besides its training pairs (docs/design/parsers.md, What a parser is).

    *strict* knows nothing, *domain* the declared predicates and the ontology, *grammar* the
    annotated grammar as well: the task categories with their rules and templates.
    """

    predicates: Mapping[str, Predicate] | None = None
    ontology: Ontology | None = None
    grammar: Sequence[TaskCategory] | None = None

    @property
    def protocol(self) -> Protocol:
        """Return the strictest protocol that allows what this holds."""
        if self.grammar is not None:
            return Protocol.GRAMMAR
        is_strict = self.predicates is None and self.ontology is None
        return Protocol.STRICT if is_strict else Protocol.DOMAIN

    def limited_to(self, protocol: str) -> Knowledge:
        """Return the part of this that ``protocol`` allows a parser to see."""
        if protocol == Protocol.GRAMMAR:
            return self
        is_domain = protocol == Protocol.DOMAIN
        return Knowledge(self.predicates, self.ontology) if is_domain else Knowledge()


@dataclass(frozen=True, slots=True)
class EpochReport:
    """One pass over the training pairs. Losses are in the unit that the registry names, accuracy is a
    fraction of 1; a value that was not measured is None. ``seconds`` is the wall time of this epoch."""

    epoch: int  # counts from 1
    train_loss: float
    validation_loss: float | None
    validation_accuracy: float | None
    seconds: float


class Cancelled(Exception):
    """Raised by ``Observer.check`` when a run is cancelled or its worker stops."""


class Observer:
    """Receives what a parser reports while it is trained. This one ignores everything."""

    def check(self) -> None:
        """Is called every batch. Raises ``Cancelled`` when the run has to stop."""

    def progress(self, fraction: float, message: str = "") -> None:
        """Take how much of the work is done, from 0 to 1."""

    def epoch(self, report: EpochReport) -> None:
        """Take the report of a finished epoch."""

    def log(self, message: str) -> None:
        """Take one line for the run's log."""

    def is_checkpoint_due(self) -> bool:
        """Return whether it is time for another checkpoint, for a training that may keep its state at
        any step."""
        return True

    def checkpoint(self, epoch: int, is_best: bool, write: Callable[[Path], None]) -> None:
        """Keep the state after ``epoch``; ``write`` writes it into an empty folder."""

    def last_checkpoint(self) -> Path | None:
        """Return the folder of the newest checkpoint of this run, from which ``fit`` resumes."""
        return None


def keep_going() -> None:
    """Never raise: the ``Check`` of work that is not cancelled."""


class Parser(ABC):
    """Maps utterances to logical forms.

    A subclass has the name that the registry gives it. Its ``version`` is raised whenever the same
    pairs, configuration and seed may give another result, or saved parsers can no longer be loaded. It
    ``reads`` older versions whose saved parsers answer as they did, so that promoted runs go on answering.
    Forms are canonical corpus text on both sides. ``score_kind`` is None where scores only order the
    answers.
    """

    name: ClassVar[str]
    version: ClassVar[int]
    reads: ClassVar[tuple[int, ...]] = ()
    protocols: ClassVar[tuple[Protocol, ...]]
    score_kind: ClassVar[ScoreKind | None] = None
    asks_a_server: ClassVar[bool] = False  # and waits for its answers, for seconds each
    Config: ClassVar[type]  # a frozen dataclass that validates itself and raises Refusal

    def __init__(self, config: Any = None, seed: int = 0, knowledge: Knowledge | None = None):
        """``config`` is a ``Config`` (None: its defaults). Equal config, seed, knowledge and pairs
        give equal predictions."""
        self.config = self.Config() if config is None else config
        self.seed = seed
        self.knowledge = knowledge or Knowledge()

    @property
    def answered_by(self) -> str:
        """The name of the model behind the answers given so far, as its server reports it; empty where this
        parser answers itself."""
        return ""

    @abstractmethod
    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        """Learn from ``train``; ``validation`` serves only to choose among what was learned.

        Resumes from ``observe.last_checkpoint()`` where there is one, with the same result as a run
        that was never stopped. Raises ``Cancelled`` from ``observe.check()``, and Refusal
        where the pairs or the knowledge do not suffice.
        """

    @abstractmethod
    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """Return for each utterance at most ``beam_width`` distinct candidates, best first; none where
        the parser has no answer."""

    def for_test_part(self, validation: Sequence[Pair]) -> Parser:
        """Return the parser that the test part is scored with; this one stays unchanged.

        It is this one, unless the method also uses the validation pairs for the test part (``knn``,
        as in the paper). The validation part is never scored with it.
        """
        return self

    def calibrated(self, pairs: Sequence[Pair]) -> Parser:
        """Return this parser with what ``fit`` chose by the validation pairs chosen by ``pairs`` instead;
        this one stays unchanged.

        What calibrates must not be scored, so the validation part is scored in folds, each by the
        parser calibrated on the others (``parser_service.runs.cross_fitting``). It is this parser where nothing
        is calibrated after training.
        """
        return self

    def hesitant(self) -> Parser:
        """Return the parser that people and robots ask; this one stays unchanged.

        It answers UNKNOWN first where an utterance is unlike everything that it has learned, at the price of
        few right answers on the validation pairs. Accuracy is measured without it. It is this one where
        the method knows no such bound.
        """
        return self

    def once(self) -> Parser:
        """Return this parser, which puts no question again that a server did not answer."""
        return self

    @abstractmethod
    def save(self, folder: Path) -> None:
        """Write the fitted parser into ``folder`` (made if absent) as JSON and safetensors."""

    @classmethod
    @abstractmethod
    def load(cls, folder: Path, knowledge: Knowledge | None = None) -> Self:
        """Load the parser that ``save`` wrote. Raises Refusal where a file is missing,
        was altered or has other contents than its name says."""

    @abstractmethod
    def parameters(self) -> int:
        """Return the number of learned weights; 0 for a parser without weights."""
