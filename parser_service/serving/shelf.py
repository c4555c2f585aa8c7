"""The parsers that the parse server holds: the promoted one of each world, and others on request."""

from __future__ import annotations

import logging
import threading
import time
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from annotations.language.grounding import Anonymized
from parser_service.models import TrainingRun
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.interface import Candidate, Parser
from parser_service.serving.batching import Batcher
from parser_service.serving.loading import load_anew, size_of
from parser_service.serving.metrics import Metrics
from parser_service.serving.preparing import WorldLanguage
from parser_service.serving.remote import SEATS, TOGETHER, RemoteAsker, Unanswered
from parser_service.serving.watching import Wanted, read_wanted
from parser_service.serving.writing import AnswerWriter

logger = logging.getLogger(__name__)

# What was heard, what the parser was given, and its answers.
Asked = tuple[Anonymized, str, list[Candidate]]
LINES_TOGETHER = 32  # of a request of many lines
AGAIN_AFTER = 30.0  # seconds until a parser that could not be loaded is tried again


class NotServed(Exception):
    """A request that cannot be answered, with its HTTP status and a sentence."""

    def __init__(self, status: int, sentence: str) -> None:
        super().__init__(sentence)
        self.status = status


@dataclass(frozen=True, slots=True)
class LoadedParser:
    """The parser of a run in memory. ``knowledge`` is what of its world it was loaded with;
    ``lines_together`` is how many lines of a longer request it is given at once."""

    run: int
    name: str
    score_kind: str
    knowledge: tuple[object, ...]
    size: int
    batcher: Batcher | RemoteAsker
    lines_together: int = LINES_TOGETHER


@dataclass(frozen=True, slots=True)
class Service:
    """A parser, and a writer with the language of its world: all that answers a request, the same while it does."""

    world: str
    parser: LoadedParser
    writer: AnswerWriter
    wanted: Wanted

    def parse(self, utterances: Sequence[str], beam: int) -> list[str]:
        """Return the answer to each utterance, as JSON. Raises as ``ask``."""
        return [self.write(each) for each in self.ask(utterances, beam)]

    def ask(self, utterances: Sequence[str], beam: int) -> list[Asked]:
        """Return what the parser answers to each utterance, and what was heard. Raises NotServed where the
        parser asks a server that does not answer in time."""
        heard = [self.writer.language.anonymizer.anonymize(each) for each in utterances]
        try:
            answers = self.parser.batcher.ask(utterances, beam)
        except Unanswered as error:
            raise NotServed(503, str(error)) from error
        return list(zip(heard, utterances, answers, strict=True))

    def write(self, asked: Asked) -> str:
        """Return an answer as JSON, with who gave it."""
        about = {
            "world": self.world,
            "run": self.parser.run,
            "parser": self.parser.name,
            "score_kind": self.parser.score_kind,
        }
        return self.writer.write(about, *asked)


class Shelf:
    """Holds parsers and gives each request one of them, whole.

    ``update`` loads what was promoted beside what answers, and then changes over; whoever answers with
    the old one ends with it. Other runs are loaded when they are asked, and take at most ``most_bytes``
    together.
    """

    def __init__(self, most_bytes: int, metrics: Metrics) -> None:
        self.metrics = metrics
        self._most_bytes = most_bytes
        self._turn = threading.Lock()
        self._seats = threading.BoundedSemaphore(SEATS)
        self._loading = threading.Lock()
        self._changed = threading.Condition()
        self._wanted: dict[str, Wanted] | None = None
        self._promoted: dict[str, Service] = {}
        self._others: OrderedDict[int, Service] = OrderedDict()
        self._failures: dict[str, tuple[Wanted, float, str]] = {}

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

    def find(self, world: str, run: int | None, patience: float) -> Service:
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

    def _wanted_in(self, world: str, patience: float) -> Wanted:
        with self._changed:
            self._changed.wait_for(lambda: self._wanted is not None, patience)
        if self._wanted is None:
            raise NotServed(503, "The parse server has not reached the database yet. Ask again.")
        if world not in self._wanted:
            self._wanted = read_wanted()  # it may be new
        if world not in self._wanted:
            raise NotServed(404, f"There is no world {world}.")
        return self._wanted[world]

    def _wait_for(self, world: str, patience: float) -> Service:
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

    def _is_due(self, name: str, wanted: Wanted) -> bool:
        service = self._promoted.get(name)
        if service is not None and service.wanted == wanted:
            return False
        failed = self._failures.get(name)
        return failed is None or failed[0] != wanted or time.monotonic() - failed[1] > AGAIN_AFTER

    def _take(self, name: str, wanted: Wanted) -> None:
        """Let the promoted run answer, or keep what answers and remember why."""
        try:
            service = self._load(name, wanted, wanted.run, self._promoted.get(name))
        except Exception as error:
            logger.warning("%s keeps its parser: run %s: %s", name, wanted.run, error)
            is_sentence = isinstance(error, ValueError)
            said = str(error) if is_sentence else f"Run {wanted.run} could not be loaded: {error!r}"
            with self._changed:
                self._failures[name] = wanted, time.monotonic(), said
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

    def _other(self, world: str, wanted: Wanted, run: int) -> Service:
        """Return a run that is not the promoted one, loading it where it is not there."""
        with self._loading:
            held = self._others.get(run)
            if held is None or held.world != world or held.wanted.language != wanted.language:
                try:
                    held = self._load(
                        world, wanted, run, held if held and held.world == world else None
                    )
                except ValueError as error:
                    raise NotServed(409, str(error)) from error
                self._make_room(held)
            self._others[run] = held
            self._others.move_to_end(run)
            return held

    def _make_room(self, service: Service) -> None:
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

    def _load(self, name: str, wanted: Wanted, run: int | None, held: Service | None) -> Service:
        """Load a run of a world with its language; what ``held`` has already is taken from there.

        Raises ValueError, a sentence, where there is no such run or no parser of it.
        """
        row = TrainingRun.objects.select_related("world").filter(world=wanted.world, pk=run).first()
        if row is None:
            raise ValueError(f"There is no run {run} in {name}.")
        is_same_language = held is not None and _words(held.wanted) == _words(wanted)
        writer = held.writer if is_same_language else AnswerWriter(WorldLanguage.of(row.world))
        knowledge = _knowledge(row, wanted)
        if held is not None and (held.parser.run, held.parser.knowledge) == (row.pk, knowledge):
            return Service(name, held.parser, writer, wanted)
        parser = load_anew(row).hesitant()
        loaded = LoadedParser(
            run=row.pk,
            name=row.parser,
            score_kind=str(parser.score_kind or ""),
            knowledge=knowledge,
            size=size_of(row),
            batcher=self._make_batcher(parser),
            lines_together=TOGETHER if parser.asks_a_server else LINES_TOGETHER,
        )
        return Service(name, loaded, writer, wanted)

    def _make_batcher(self, parser: Parser) -> Batcher | RemoteAsker:
        if parser.asks_a_server:
            return RemoteAsker(parser.predict, self._seats)
        return Batcher(parser.predict, self._turn, self.metrics.batches.observe)


def _words(wanted: Wanted) -> tuple[object, ...]:
    """Return what changes when the language of the world has to be read anew."""
    return wanted.language, wanted.revision, wanted.names


def _knowledge(run: TrainingRun, wanted: Wanted) -> tuple[object, ...]:
    """Return what changes when the run has to be loaded anew: what its protocol lets it know."""
    if run.protocol == Protocol.STRICT:
        return ()
    is_domain = run.protocol == Protocol.DOMAIN
    return wanted.language if is_domain else (*wanted.language, wanted.revision)


def _nobody_answers(world: str, wanted: Wanted) -> str:
    """Return why no parser answers in a world, and what there is to do."""
    sentence = f"No run of {world} has been promoted yet, so no parser answers there."
    if TrainingRun.objects.active().filter(world=wanted.world).exists():
        return (
            f"{sentence} Parsers are being trained there; the first that is right on paraphrases will "
            "answer by itself. Ask again later."
        )
    return f"{sentence} Train one on paraphrases, or promote one."
