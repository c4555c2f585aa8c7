"""What a parser is: three verbs (fit, predict, save and load) and the values they pass."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

if TYPE_CHECKING:
    from annotations.language.expansion import TaskCategory
    from annotations.language.ontology import Ontology
    from annotations.language.predicates import Predicate

Protocol = Literal["strict", "domain", "grammar"]
PROTOCOLS: tuple[Protocol, ...] = ("strict", "domain", "grammar")

Check = Callable[[], None]
"""Called between batches; raises ``Cancelled`` when the work is to stop."""


@dataclass(frozen=True, slots=True)
class Pair:
    """One example. ``form`` is canonical corpus text."""

    utterance: str
    form: str
    source: Literal["generated", "paraphrased"] = "generated"
    task_category: str = ""


@dataclass(frozen=True, slots=True)
class Candidate:
    """One answer.

    ``form`` is canonical corpus text, or the text that the parser made where that is no form;
    ``score`` orders the candidates of one utterance and is comparable within one parser only.
    """

    form: str
    score: float


@dataclass(frozen=True, slots=True)
class Knowledge:
    """What a parser may know beside its training pairs (DESIGN §5).

    *strict* knows nothing, *domain* the declared predicates and the ontology, *grammar* the
    annotated grammar as well: the task categories with their rules and templates.
    """

    predicates: Mapping[str, Predicate] | None = None
    ontology: Ontology | None = None
    grammar: Sequence[TaskCategory] | None = None

    @property
    def protocol(self) -> Protocol:
        """The least protocol that allows what this holds."""
        if self.grammar is not None:
            return "grammar"
        return "strict" if self.predicates is None and self.ontology is None else "domain"

    def limited_to(self, protocol: Protocol) -> Knowledge:
        """The part of this that ``protocol`` allows a parser to see."""
        if protocol == "grammar":
            return self
        return Knowledge(self.predicates, self.ontology) if protocol == "domain" else Knowledge()


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
    """What a parser tells whoever trains it. This one listens to nothing and keeps nothing."""

    def check(self) -> None:
        """Called every batch. Raises ``Cancelled`` when the run is to stop."""

    def progress(self, fraction: float, message: str = "") -> None:
        """How far the work is, from 0 to 1."""

    def epoch(self, report: EpochReport) -> None:
        """An epoch is over."""

    def log(self, message: str) -> None:
        """One line for the run's log."""

    def checkpoint(self, epoch: int, is_best: bool, write: Callable[[Path], None]) -> None:
        """Keep the state after ``epoch``: ``write`` fills an empty folder with it."""

    def last_checkpoint(self) -> Path | None:
        """The folder of the newest checkpoint of this run, from which ``fit`` goes on."""
        return None

    def best_checkpoint(self) -> Path | None:
        """The folder of the best checkpoint of this run; a parser can be loaded from it."""
        return None


def keep_going() -> None:
    """The ``Check`` of work that nobody stops."""


class Parser(ABC):
    """Maps utterances to logical forms.

    A subclass names itself as the registry does and raises ``version`` whenever the same pairs,
    configuration and seed may give another result. Forms are canonical corpus text on both sides.
    """

    name: ClassVar[str]
    version: ClassVar[int]
    protocols: ClassVar[tuple[Protocol, ...]]
    Config: ClassVar[type]  # a frozen dataclass that validates itself, ValueError sentences

    def __init__(self, config: Any = None, seed: int = 0, knowledge: Knowledge | None = None):
        """``config`` is a ``Config`` (None: its defaults). Equal config, seed, knowledge and pairs
        give equal predictions."""
        self.config = self.Config() if config is None else config
        self.seed = seed
        self.knowledge = knowledge or Knowledge()

    @abstractmethod
    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        """Learns from ``train``; ``validation`` serves only to choose among what was learned.

        Goes on from ``observe.last_checkpoint()`` where there is one, to the same end as an
        undisturbed run. Raises ``Cancelled`` from ``observe.check()`` and ValueError, a sentence,
        where the pairs or the knowledge do not suffice.
        """

    @abstractmethod
    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """For each utterance at most ``beam_width`` distinct candidates, best first; none where the
        parser has no answer."""

    def for_test_part(self, validation: Sequence[Pair]) -> Parser:
        """The parser with which the test part is scored, leaving this one unchanged.

        Itself, unless the method consults the validation pairs as well by then (``knn``, as in
        the paper). Scores on the validation part never go through here.
        """
        return self

    @abstractmethod
    def save(self, folder: Path) -> None:
        """Writes the fitted parser into ``folder`` (made if absent) as JSON and safetensors."""

    @classmethod
    @abstractmethod
    def load(cls, folder: Path, knowledge: Knowledge | None = None) -> Self:
        """The parser that ``save`` wrote. Raises ValueError, a sentence, where a file is missing,
        altered since or not what its name says."""

    @abstractmethod
    def parameters(self) -> int:
        """The number of learned weights; 0 where nothing is learned by weights."""
