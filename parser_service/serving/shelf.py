"""The parsers that the parse server holds: the promoted one of each world, and others on request."""

from __future__ import annotations

import logging
import threading
import time
from collections import OrderedDict, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any

from django.db.models import Count, Max, Sum

from annotations.language.errors import Refusal
from annotations.language.grounding import Anonymized
from annotations.models import (
    Editable,
    Entity,
    EntityClass,
    Predicate,
    Primitive,
    Recipe,
    World,
)
from parser_service.models import ActionNames, Promotion, TrainingRun
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.interface import Candidate, Parser
from parser_service.parsers.registry import entry
from parser_service.serving.answer_writing import AnswerWriter
from parser_service.serving.batching import Batcher
from parser_service.serving.loading import load_anew, make_untrained, size_of
from parser_service.serving.metrics import Metrics
from parser_service.serving.preparing import WorldLanguage
from parser_service.serving.remote import PATIENCE, SEATS, TOGETHER, RemoteAsker, Unanswered

logger = logging.getLogger(__name__)

# What was heard, what the parser was given, and its answers.
AskedUtterance = tuple[Anonymized, str, list[Candidate]]
LINES_TOGETHER = 32  # of a request of many lines
AGAIN_AFTER = 30.0  # seconds until a parser that could not be loaded is tried again


class NotServed(Refusal):
    """A request that cannot be answered, with its HTTP status and a sentence."""

    code = "not_served"

    def __init__(self, status: int, sentence: str) -> None:
        super().__init__(sentence, status=status)


@dataclass(frozen=True, slots=True)
class LoadedParser:
    """The parser of a run in memory. ``knowledge`` is what of its world it was loaded with;
    ``lines_together`` is how many lines of a longer request it is given at once. ``run`` is None for a
    parser that needs none."""

    run: int | None
    name: str
    score_kind: str
    knowledge: tuple[object, ...]
    size: int
    batcher: Batcher | RemoteAsker
    lines_together: int = LINES_TOGETHER


@dataclass(frozen=True, slots=True)
class ServedParser:
    """A parser and the writer of its world. They answer a request and do not change meanwhile."""

    world: str
    parser: LoadedParser
    writer: AnswerWriter
    wanted: WantedParser

    def parse(self, utterances: Sequence[str], beam: int) -> list[str]:
        """Return the answer to each utterance, as JSON. Raises as ``ask``."""
        return [self.write(each) for each in self.ask(utterances, beam)]

    def ask(self, utterances: Sequence[str], beam: int) -> list[AskedUtterance]:
        """Return what the parser answers to each utterance, and what was heard. Raises NotServed where the
        parser asks a server that does not answer in time."""
        heard = [self.writer.language.anonymizer.anonymize(each) for each in utterances]
        try:
            answers = self.parser.batcher.ask(utterances, beam)
        except Unanswered as error:
            raise NotServed(503, error.message) from error
        return list(zip(heard, utterances, answers, strict=True))

    def heard_nothing(self) -> AskedUtterance:
        """Return what there is to write where nothing was said: no candidate, without asking the parser."""
        return self.writer.language.anonymizer.anonymize(""), "", []

    def write(self, asked: AskedUtterance) -> str:
        """Return an answer as JSON, with who gave it."""
        about = {
            "world": self.world,
            "run": self.parser.run,
            "parser": self.parser.name,
            "score_kind": self.parser.score_kind,
        }
        return self.writer.write(about, *asked)


@dataclass(frozen=True, slots=True)
class WantedParser:
    """A world, the key of its promoted run (None: none), and what changes whenever its words do.

    ``language`` stands for ontology and predicates, ``revision`` for the grammar, ``names`` for those
    of actions, and ``recipes`` for these and the primitives.
    """

    world: int
    run: int | None
    language: tuple[object, ...]
    revision: int
    names: int = 0
    recipes: tuple[object, ...] = ()

    def knowledge(self, protocol: str) -> tuple[object, ...]:
        """Return what a run may know of the world; it is loaded anew where that changes."""
        if protocol == Protocol.STRICT:
            return ()
        return self.language if protocol == Protocol.DOMAIN else (*self.language, self.revision)


def read_wanted() -> dict[str, WantedParser]:
    """Return world name → what is wanted there, in eight queries.

    Every edit and import of rows adds, deletes or raises a version, so that number, last key and sum of
    the versions together change.
    """
    language = _totals((Entity, "ontology__world"), (EntityClass, "world"), (Predicate, "world"))
    recipes = _totals((Primitive, "world"), (Recipe, "world"))
    runs = dict(Promotion.objects.present().order_by().values_list("world", "run"))
    names = dict(ActionNames.objects.values_list("world", "version"))
    rows = World.objects.present().values_list("pk", "name", "revision")
    return {
        name: WantedParser(
            key,
            runs.get(key),
            tuple(language[key]),
            revision,
            names.get(key, 0),
            tuple(recipes[key]),
        )
        for key, name, revision in rows
    }


def _totals(*models: tuple[type[Editable], str]) -> dict[int, list[object]]:
    """Return world → number, last key and sum of the versions of its rows of each model; the path leads to it."""
    totals: dict[int, list[object]] = defaultdict(list)
    for model, path in models:
        rows = model._default_manager.order_by().values_list(path)
        for world, *of_world in rows.annotate(Count("pk"), Max("pk"), Sum("version")):
            totals[world] += [model.__name__, *of_world]
    return totals


class Shelf:
    """Holds parsers and gives each request one of them, whole.

    ``update`` loads what was promoted beside what answers, and then changes over; whoever answers with
    the old one ends with it. Other runs are loaded when they are asked, and take at most ``most_bytes``
    together.

    ``patience`` is how many seconds a request waits for a parser that asks a server elsewhere.
    """

    def __init__(self, most_bytes: int, metrics: Metrics, patience: float = PATIENCE) -> None:
        self.metrics = metrics
        self._patience = patience
        self._most_bytes = most_bytes
        self._turn = threading.Lock()
        self._seats = threading.BoundedSemaphore(SEATS)
        self._loading = threading.Lock()
        self._changed = threading.Condition()
        self._wanted: dict[str, WantedParser] | None = None
        self._promoted: dict[str, ServedParser] = {}
        self._others: OrderedDict[int, ServedParser] = OrderedDict()
        self._failures: dict[str, tuple[WantedParser, float, str]] = {}

    @property
    def is_ready(self) -> bool:
        """Whether the promoted parsers were looked for, and loaded where that succeeded."""
        return self._wanted is not None and not any(map(self._is_coming, self._wanted))

    def describe(self) -> list[dict[str, Any]]:
        """Return for each world with a promoted run what answers there, and what went wrong."""
        wanted = self._wanted or {}
        return [
            {
                "world": name,
                "promoted": each.run,
                "run": self._promoted[name].parser.run if name in self._promoted else None,
                "problem": self._failures[name][2] if name in self._failures else "",
            }
            for name, each in wanted.items()
            if each.run is not None
        ]

    def update(self) -> None:
        """Hold what the database says now. Raises what the database raises."""
        wanted = read_wanted()
        with self._changed:
            self._wanted = wanted
            self._promoted = {
                name: service
                for name, service in self._promoted.items()
                if name in wanted and wanted[name].run is not None
            }
            self._changed.notify_all()
        for name, each in wanted.items():
            if each.run is not None and self._is_due(name, each):
                self._take(name, each)
        self.metrics.parsers.set(len(self._promoted) + len(self._others))

    def find(self, world: str, run: int | None, patience: float) -> ServedParser:
        """Return what answers in ``world``: its promoted parser, or that of ``run``.

        Waits up to ``patience`` seconds for a parser that is being loaded. Raises NotServed.
        """
        wanted = self._wanted_in(world, patience)
        service = self._promoted.get(world)
        if run is not None and (service is None or service.parser.run != run):
            return self._other(world, wanted, run)
        if service is None and wanted.run is None:
            raise NotServed(409, _nobody_answers(world, wanted))
        if service is None:
            service = self._wait_for(world, patience)
        return service

    def load(self, world: str, run: int | None, untrained: str = "") -> ServedParser:
        """Return what answers in ``world``, loaded for the caller alone: its promoted parser, that of ``run``,
        or the parser ``untrained``, which needs no run. Raises Refusal."""
        wanted = read_wanted().get(world)
        if wanted is None:
            raise Refusal(f"There is no world {world}.", "no_such_world", HTTPStatus.NOT_FOUND)
        if untrained:
            row = World.objects.get(pk=wanted.world)
            parser = make_untrained(untrained, row)
            loaded = self._hold(parser, knowledge=wanted.knowledge(entry(untrained).protocols[-1]))
            return ServedParser(world, loaded, AnswerWriter(WorldLanguage.of(row)), wanted)
        if run is None and wanted.run is None:
            raise Refusal(_nobody_answers(world, wanted), "no_promoted_run", HTTPStatus.CONFLICT)
        return self._load(world, wanted, run or wanted.run, None)

    def _wanted_in(self, world: str, patience: float) -> WantedParser:
        with self._changed:
            self._changed.wait_for(lambda: self._wanted is not None, patience)
        if self._wanted is None:
            raise NotServed(503, "The parse server has not reached the database yet. Ask again.")
        if world not in self._wanted:
            self._wanted = read_wanted()  # it may be new
        if world not in self._wanted:
            raise NotServed(404, f"There is no world {world}.")
        return self._wanted[world]

    def _wait_for(self, world: str, patience: float) -> ServedParser:
        with self._changed:
            self._changed.wait_for(
                lambda: world in self._promoted or not self._is_coming(world), patience
            )
        if service := self._promoted.get(world):
            return service
        problem = self._failures[world][2] if world in self._failures else "It is being loaded."
        raise NotServed(503, f"The promoted parser of {world} is not there. {problem}")

    def _is_coming(self, world: str) -> bool:
        is_wanted = bool(self._wanted and world in self._wanted and self._wanted[world].run)
        return is_wanted and world not in self._promoted and world not in self._failures

    def _is_due(self, name: str, wanted: WantedParser) -> bool:
        service = self._promoted.get(name)
        if service is not None and service.wanted == wanted:
            return False
        failed = self._failures.get(name)
        return failed is None or failed[0] != wanted or time.monotonic() - failed[1] > AGAIN_AFTER

    def _take(self, name: str, wanted: WantedParser) -> None:
        """Let the promoted run answer, or keep what answers and remember why."""
        try:
            service = self._load(name, wanted, wanted.run, self._promoted.get(name))
        except Exception as error:
            logger.warning(
                "%s keeps its parser: run %s: %s",
                name,
                wanted.run,
                error,
                exc_info=not isinstance(error, Refusal),
            )
            see_log = f"Run {wanted.run} could not be loaded. The log of the parse server says why."
            problem = error.message if isinstance(error, Refusal) else see_log
            with self._changed:
                self._failures[name] = wanted, time.monotonic(), problem
                self._changed.notify_all()
            return
        with self._changed:
            before = self._promoted.get(name)
            self._promoted = {**self._promoted, name: service}
            self._failures.pop(name, None)
            self._changed.notify_all()
        if before is None or before.parser.run != service.parser.run:
            self.metrics.changes.labels(world=name).inc()
            logger.info("Run %s (%s) answers in %s.", wanted.run, service.parser.name, name)

    def _other(self, world: str, wanted: WantedParser, run: int) -> ServedParser:
        """Return a run that is not the promoted one, loading it where it is not there."""
        with self._loading:
            held = self._others.get(run)
            if held is None or held.world != world or held.wanted.language != wanted.language:
                try:
                    held = self._load(
                        world, wanted, run, held if held and held.world == world else None
                    )
                except Refusal as error:
                    raise NotServed(409, error.message) from error
                self._make_room(held)
            self._others[run] = held
            self._others.move_to_end(run)
            return held

    def _make_room(self, service: ServedParser) -> None:
        """Forget the runs that were not asked for the longest time. Raises NotServed for one too large."""
        if service.parser.size > self._most_bytes:
            raise NotServed(
                409,
                f"The parser of run {service.parser.run} takes {service.parser.size / 1e6:,.0f} MB, and "
                f"runs that are not promoted may take {self._most_bytes / 1e6:,.0f} MB here "
                "(PARSER_MEMORY_MB).",
            )
        used = service.parser.size + sum(
            each.parser.size for key, each in self._others.items() if key != service.parser.run
        )
        while used > self._most_bytes:
            key, oldest = next(iter(self._others.items()))
            del self._others[key]
            used -= oldest.parser.size if key != service.parser.run else 0

    def _load(
        self, name: str, wanted: WantedParser, run: int | None, held: ServedParser | None
    ) -> ServedParser:
        """Load a run of a world with its language; what ``held`` has already is taken from there.

        Raises Refusal where there is no such run or no parser of it.
        """
        of_world = TrainingRun.objects.select_related("world").filter(world=wanted.world)
        row = None if run is None else of_world.filter(pk=run).first()
        if row is None:
            raise Refusal(f"There is no run {run} in {name}.", "no_such_run", HTTPStatus.CONFLICT)
        if held is not None and _words(held.wanted) == _words(wanted):
            writer = held.writer
        else:
            writer = AnswerWriter(WorldLanguage.of(row.world))
        knowledge = wanted.knowledge(row.protocol)
        if held is not None and (held.parser.run, held.parser.knowledge) == (row.pk, knowledge):
            return ServedParser(name, held.parser, writer, wanted)
        parser = load_anew(row).hesitant()
        loaded = self._hold(parser, knowledge, row.pk, size_of(row))
        return ServedParser(name, loaded, writer, wanted)

    def _hold(
        self, parser: Parser, knowledge: tuple[object, ...], run: int | None = None, size: int = 0
    ) -> LoadedParser:
        # What needs no run looks at each line alone, so that several together would only come later.
        together = 1 if run is None else LINES_TOGETHER
        return LoadedParser(
            run=run,
            name=parser.name,
            score_kind=str(parser.score_kind or ""),
            knowledge=knowledge,
            size=size,
            batcher=RemoteAsker(parser.predict, self._seats, self._patience)
            if parser.asks_a_server
            else Batcher(parser.predict, self._turn, self.metrics.batches.observe),
            lines_together=TOGETHER if parser.asks_a_server else together,
        )


def _words(wanted: WantedParser) -> tuple[object, ...]:
    """Return what changes when the language of the world has to be read anew."""
    return wanted.language, wanted.revision, wanted.names, wanted.recipes


def _nobody_answers(world: str, wanted: WantedParser) -> str:
    """Return why no parser answers in a world, and what there is to do."""
    sentence = f"No run of {world} has been promoted yet, so no parser answers there."
    if TrainingRun.objects.active().filter(world=wanted.world).exists():
        return (
            f"{sentence} Parsers are being trained there; the first that is right on paraphrases will "
            "answer by itself. Ask again later."
        )
    return f"{sentence} Train one on paraphrases, or promote one."
