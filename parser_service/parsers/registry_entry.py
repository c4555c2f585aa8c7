"""What a parser is registered with. Whoever registers one imports this and nothing else of the registry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from parser_service.parsers.conditions import Protocol

QUEUES = ("quick", "cpu", "gpu")


class Needs(StrEnum):
    """What a parser needs most before it can be trained."""

    NOTHING = "nothing"
    CPU = "minutes on a CPU"
    GPU = "a GPU recommended"
    WEIGHTS = "weights to bring"
    SERVER = "a server to ask"


@dataclass(frozen=True, slots=True)
class Expectation:
    """What to expect of a parser: exact match of generated commands and of what people say, fractions of 1, None
    where nobody has measured it. Or ``instead``, a text. Then how long a training takes and the memory it needs."""

    generated: float | None = None
    said: float | None = None
    instead: str = ""
    time: str = ""
    memory: str = ""

    @property
    def accuracy(self) -> str:
        """The figures in words; empty where there are none."""
        shares = ((self.generated, "generated commands"), (self.said, "what people say"))
        shown = [f"{100 * share:.0f} % of {words}" for share, words in shares if share is not None]
        return self.instead or "; ".join(shown)


@dataclass(frozen=True, slots=True)
class RegistryEntry:
    """One parser as pages, the worker and the command line see it.

    ``in_short`` says in one plain sentence what it does, ``description`` how.

    ``dotted`` is the path of its class (which may import torch), ``config`` of its hyperparameters
    (which may not); ``queue`` names the workers that may run it: ``quick`` where training takes seconds and
    needs no torch, otherwise ``cpu`` or ``gpu``. ``loss_unit`` is that of the losses it reports.
    ``learns`` is False where training pairs change nothing, ``writes_new_forms`` where it never answers with a
    form that no training pair has.
    ``may_know_corpora`` marks figures of a model that may have read a public corpus, test part and all,
    before anybody trained it here. ``most_subwords`` is how many it reads of an utterance, 0 where it reads
    all or where that is up to its weights.
    ``expected`` is what does not depend on the split. ``published`` has the figures of Walker, Peng and Cakmak
    (2019), table III: setting → exact match in percent on the test part by command and by logical form.
    ``after`` is the parser behind which lists have one that a package registers; empty for the end.
    """

    dotted: str
    config: str
    title: str
    description: str
    version: int
    protocols: tuple[Protocol, ...]
    in_short: str = ""
    needs: Needs = Needs.CPU
    queue: str = "cpu"
    loss_unit: str = "nats a token"
    learns: bool = True
    writes_new_forms: bool = True
    may_know_corpora: bool = False
    most_subwords: int = 0
    expected: Expectation | None = None
    published: Mapping[tuple[str, str], tuple[float, float]] = field(default_factory=dict)
    after: str = ""
