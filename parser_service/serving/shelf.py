"""The parsers that the parse server holds: the promoted one of each world, and others on request."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections import OrderedDict, defaultdict
from dataclasses import dataclass, replace
from http import HTTPStatus
from typing import Any

from django.db.models import Count, Max, Sum

from annotations.language.grounding import HearingReader
from annotations.language.plans import StoppingWords
from annotations.language.texts import LanguageError, Refusal
from annotations.models import (
    Editable,
    Entity,
    EntityClass,
    Predicate,
    Primitive,
    Recipe,
    World,
)
from parser_service.analysis.sureness import ALLOWED_WRONG
from parser_service.models import (
    ActionNames,
    AnswererEvaluation,
    Answering,
    AnsweringOrder,
    Promotion,
    TrainingRun,
)
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.interface import Parser
from parser_service.parsers.oracle import GrammarOracle
from parser_service.parsers.registry import ORACLE, untrained
from parser_service.runs.promoting import last_runs
from parser_service.serving.answer_writing import AnswerWriter
from parser_service.serving.answerer import (
    LINES_TOGETHER,
    Answerer,
    LoadedParser,
    NotServed,
)
from parser_service.serving.batching import Batcher
from parser_service.serving.calibrating import calibrated
from parser_service.serving.loading import load_anew, make_untrained, size_of
from parser_service.serving.metrics import Metrics
from parser_service.serving.preparing import WorldLanguage
from parser_service.serving.remote import LAST_SHARE, PATIENCE, SEATS, TOGETHER, RemoteAsker

logger = logging.getLogger(__name__)

AGAIN_AFTER = 30.0  # seconds until a parser that could not be loaded is tried again
MOST_UNPROMOTED = (
    100  # worlds without a promoted run whose oracle is kept, the last that were asked
)


@dataclass(frozen=True, slots=True)
class WantedAnswerer:
    """A world, the key of its promoted run (None: none), and what changes whenever its words do.

    ``language`` stands for ontology and predicates, ``revision`` for the grammar, ``names`` for those
    of actions, and ``recipes`` for these and the primitives; ``measured`` for what was last measured of its answers.
    ``last_run`` is the key of the run whose language model is asked last.
    """

    world: int
    run: int | None
    language: tuple[object, ...]
    revision: int
    names: int = 0
    recipes: tuple[object, ...] = ()
    order: str = AnsweringOrder.BOTH
    allowed_wrong: float = ALLOWED_WRONG
    measured: int = 0
    last_run: int | None = None

    def knowledge(self, protocol: str) -> tuple[object, ...]:
        """Return what a run may know of the world; it is loaded anew where that changes."""
        if protocol == Protocol.STRICT:
            return ()
        return self.language if protocol == Protocol.DOMAIN else (*self.language, self.revision)


def read_wanted() -> dict[str, WantedAnswerer]:
    """Return world name → what is wanted there, in eleven queries.

    Every edit and import of rows adds, deletes or raises a version, so that number, last key and sum of
    the versions together change.
    """
    language = _totals((Entity, "ontology__world"), (EntityClass, "world"), (Predicate, "world"))
    recipes = _totals((Primitive, "world"), (Recipe, "world"))
    runs = dict(Promotion.objects.present().order_by().values_list("world", "run"))
    names = dict(ActionNames.objects.values_list("world", "version"))
    chosen = {row.world_id: row for row in Answering.objects.all()}
    asking = [world for world, row in chosen.items() if row.asks_language_model]
    last = dict(last_runs().filter(world__in=asking).order_by("pk").values_list("world", "pk"))
    rated = AnswererEvaluation.objects.order_by().values_list("world")
    measured = dict(rated.annotate(Max("pk")))
    rows = World.objects.present().values_list("pk", "name", "revision")
    return {
        name: WantedAnswerer(
            key,
            runs.get(key),
            tuple(language[key]),
            revision,
            names.get(key, 0),
            tuple(recipes[key]),
            chosen[key].order if key in chosen else AnsweringOrder.BOTH,
            chosen[key].allowed_wrong if key in chosen else ALLOWED_WRONG,
            measured.get(key, 0),
            last.get(key),
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
    """Holds what answers in each world, and gives each request one answerer, whole.

    ``update`` loads what was promoted beside what answers, and then changes over; whoever answers with
    the old one ends with it. The oracle of a world without a promoted run is made when it is first asked.
    Other runs are loaded when they are asked, and take at most ``most_bytes`` together.

    ``patience`` is how many seconds a request waits for a parser that asks a server elsewhere.
    """

    def __init__(self, most_bytes: int, metrics: Metrics, patience: float = PATIENCE) -> None:
        self.metrics = metrics
        self._patience = patience
        self._most_bytes = most_bytes
        self._turn = threading.Lock()
        self._seats = threading.BoundedSemaphore(SEATS)
        self._loading = threading.RLock()
        self._changed = threading.Condition()
        self._wanted: dict[str, WantedAnswerer] | None = None
        self._answerers: OrderedDict[str, Answerer] = OrderedDict()
        self._others: OrderedDict[int, Answerer] = OrderedDict()
        self._failures: dict[str, tuple[WantedAnswerer, float, str]] = {}

    @property
    def is_ready(self) -> bool:
        """Whether the promoted parsers were looked for, and loaded where that succeeded."""
        return self._wanted is not None and not any(map(self._is_coming, self._wanted))

    def describe(self) -> list[dict[str, Any]]:
        """Return for each world with a promoted run what answers there, and what went wrong."""
        return [
            {
                "world": name,
                "promoted": each.run,
                "run": self._run_in(name),
                "problem": self._failures[name][2] if name in self._failures else "",
            }
            for name, each in (self._wanted or {}).items()
            if each.run is not None
        ]

    def update(self) -> None:
        """Hold what the database says now. Raises what the database raises."""
        wanted = read_wanted()
        with self._changed:
            self._wanted = wanted
            for name in [each for each in self._answerers if each not in wanted]:
                del self._answerers[name]
            self._changed.notify_all()
        for name, each in wanted.items():
            if (each.run is not None or name in self._answerers) and self._is_due(name, each):
                self._take(name, each)
        self.metrics.parsers.set(len(self._answerers) + len(self._others))

    def find(self, world: str, run: int | None, patience: float, parser: str = "") -> Answerer:
        """Return what answers in ``world``; with ``run`` the parser of that run alone, with ``parser`` one alone that
        needs no run.

        Waits up to ``patience`` seconds for a parser that is being loaded. Raises NotServed.
        """
        wanted = self._wanted_in(world, patience)
        if run is not None:
            return self._other(world, wanted, run)
        if wanted.run is not None and world not in self._answerers:
            self._wait_for(world, patience)
        answerer = self._answerers.get(world)
        if answerer is None or (wanted.run is None and answerer.wanted != wanted):
            answerer = self._take_unpromoted(world, wanted)
        return self._alone(answerer) if parser else answerer

    def load(
        self, world: str, run: int | None = None, parser: str = "", order: str | None = None
    ) -> Answerer:
        """Return what answers in ``world``, loaded for the caller alone; with ``run`` or ``parser`` that one alone.
        ``order`` is an ``AnsweringOrder``, that of the world by default. Raises Refusal."""
        wanted = read_wanted().get(world)
        if wanted is None:
            raise Refusal(f"There is no world {world}.", "no_such_world", HTTPStatus.NOT_FOUND)
        if run is not None:
            return self._load_run(world, wanted, run, None)
        if parser:
            writer = self._writer(_world(world, wanted), wanted, None)
            reader = _reader(writer, None)
            return self._alone(Answerer(world, writer, reader, _stopping(writer), wanted=wanted))
        return self._load(world, replace(wanted, order=order) if order else wanted, None)

    def _alone(self, answerer: Answerer) -> Answerer:
        """Return the oracle of a world alone. Raises NotServed where the world has no templates."""
        oracle = answerer.oracle
        if oracle is None:
            with self._loading:
                world = _world(answerer.world, answerer.wanted)
                oracle = self._oracle(world, answerer.wanted, None)
        if oracle is None:
            sentence = (
                f"{answerer.world} has no templates, so its grammar oracle understands nothing."
            )
            raise NotServed(409, f"{sentence} Write templates first.", "no_templates")
        reader = _reader(answerer.writer, oracle)
        return replace(
            answerer,
            reader=reader,
            oracle=oracle,
            learned=None,
            last=None,
            problem="",
            last_problem="",
        )

    def _run_in(self, world: str) -> int | None:
        answerer = self._answerers.get(world)
        return answerer.learned.run if answerer and answerer.learned else None

    def _wanted_in(self, world: str, patience: float) -> WantedAnswerer:
        with self._changed:
            self._changed.wait_for(lambda: self._wanted is not None, patience)
        if self._wanted is None:
            sentence = "The parse server has not reached the database yet. Ask again."
            raise NotServed(503, sentence, "database_away")
        if world not in self._wanted:
            self._wanted = read_wanted()  # it may be new
        if world not in self._wanted:
            raise NotServed(404, f"There is no world {world}.", "unknown_world")
        return self._wanted[world]

    def _wait_for(self, world: str, patience: float) -> None:
        """Wait for the promoted run of a world. Raises NotServed where it has not come by then."""
        with self._changed:
            has_come = self._changed.wait_for(lambda: not self._is_coming(world), patience)
        if not has_come:
            raise NotServed(
                503,
                f"The promoted parser of {world} is not there. It is being loaded.",
                "parser_loading",
            )

    def _is_coming(self, world: str) -> bool:
        is_wanted = bool(self._wanted and world in self._wanted and self._wanted[world].run)
        return is_wanted and world not in self._answerers and world not in self._failures

    def _is_due(self, name: str, wanted: WantedAnswerer) -> bool:
        answerer = self._answerers.get(name)
        if answerer is not None and answerer.wanted == wanted and not answerer.problem:
            return False
        failed = self._failures.get(name)
        return failed is None or failed[0] != wanted or time.monotonic() - failed[1] > AGAIN_AFTER

    def _take(self, name: str, wanted: WantedAnswerer) -> None:
        """Let the promoted run answer, or keep what answers and remember why."""
        before = self._answerers.get(name)
        try:
            answerer = self._load(name, wanted, before)
        except Exception as error:
            if wanted.run is None:  # nobody waits for it; whoever asks next hears why
                self._answerers.pop(name, None)
                return
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
        run = self._run_in(name)
        with self._changed:
            self._answerers[name] = answerer
            self._failures.pop(name, None)
            self._changed.notify_all()
        if answerer.learned is not None and answerer.learned.run != run:
            self.metrics.changes.labels(world=name).inc()
            logger.info("Run %s (%s) answers in %s.", wanted.run, answerer.learned.name, name)

    def _take_unpromoted(self, name: str, wanted: WantedAnswerer) -> Answerer:
        """Return what answers in a world of which no run is there: the oracle alone. Raises NotServed."""
        failed = self._failures.get(name)
        with self._loading:
            try:
                without_run = replace(wanted, run=None)
                answerer = self._load(name, without_run, self._answerers.get(name))
            except Refusal as error:
                problem = failed[2] if failed else error.message
                raise NotServed(503 if failed else 409, problem, error.code) from error
            if failed:
                answerer = replace(answerer, problem=failed[2])
            self._answerers[name] = answerer
            self._answerers.move_to_end(name)
            unpromoted = [each for each, held in self._answerers.items() if held.wanted.run is None]
            for each in unpromoted[:-MOST_UNPROMOTED]:
                del self._answerers[each]
            return answerer

    def _other(self, world: str, wanted: WantedAnswerer, run: int) -> Answerer:
        """Return a run alone, loading it where it is not there."""
        held = self._answerers.get(world)
        if held is not None and held.learned is not None and held.learned.run == run:
            return replace(held, oracle=None, last=None, problem="", last_problem="")
        with self._loading:
            other = self._others.get(run)
            if other is None or other.world != world or other.wanted.language != wanted.language:
                try:
                    other = self._load_run(
                        world, wanted, run, other if other and other.world == world else None
                    )
                except Refusal as error:
                    raise NotServed(409, error.message, error.code) from error
                self._make_room(other)
            self._others[run] = other
            self._others.move_to_end(run)
            return other

    def _make_room(self, answerer: Answerer) -> None:
        """Forget the runs that were not asked for the longest time. Raises NotServed for one too large."""
        run, size = answerer.run, answerer.size
        if size > self._most_bytes:
            raise NotServed(
                409,
                f"The parser of run {run} takes {size / 1e6:,.0f} MB, and "
                f"runs that are not promoted may take {self._most_bytes / 1e6:,.0f} MB here "
                "(PARSER_MEMORY_MB).",
                "parser_too_large",
            )
        used = size + sum(each.size for key, each in self._others.items() if key != run)
        while used > self._most_bytes:
            key, oldest = next(iter(self._others.items()))
            del self._others[key]
            used -= oldest.size if key != run else 0

    def _load(self, name: str, wanted: WantedAnswerer, held: Answerer | None) -> Answerer:
        """Load the parts of a world; what ``held`` has already is taken from there. Raises Refusal without any."""
        world = _world(name, wanted)
        writer = self._writer(world, wanted, held)
        learned = None
        if wanted.run is not None and wanted.order != AnsweringOrder.ORACLE:
            learned = self._learned(name, wanted, wanted.run, held.learned if held else None)
        oracle = None
        if wanted.order != AnsweringOrder.LEARNED or learned is None:
            oracle = self._oracle(world, wanted, held.oracle if held else None)
        if oracle is None and learned is None:
            raise Refusal(_nobody_answers(name, wanted), "no_promoted_run", HTTPStatus.CONFLICT)
        run = learned.run if learned else None
        last, last_problem = None, ""
        if wanted.last_run not in (None, run):
            try:
                last = self._learned(
                    name, wanted, wanted.last_run, held.last if held else None, is_last=True
                )
            except Refusal as error:
                last_problem = error.message
        sureness = calibrated(world, run, wanted.order, wanted.allowed_wrong, wanted.last_run)
        return Answerer(
            world=name,
            writer=writer,
            reader=_reader(writer, oracle),
            stopping=_stopping(writer),
            oracle=oracle,
            learned=learned,
            last=last,
            calibrated=sureness,
            last_problem=last_problem,
            wanted=wanted,
        )

    def _load_run(
        self, name: str, wanted: WantedAnswerer, run: int, held: Answerer | None
    ) -> Answerer:
        """Load a run alone. Raises Refusal where there is no such run or no parser of it."""
        learned = self._learned(name, wanted, run, held.learned if held else None, any_parser=True)
        world = _world(name, wanted)
        writer = self._writer(world, wanted, held)
        sureness = calibrated(world, run, AnsweringOrder.LEARNED, wanted.allowed_wrong)
        reader = _reader(writer, None)
        return Answerer(
            name,
            writer,
            reader,
            _stopping(writer),
            learned=learned,
            calibrated=sureness,
            wanted=wanted,
        )

    def _writer(self, world: World, wanted: WantedAnswerer, held: Answerer | None) -> AnswerWriter:
        if held is not None and _words(held.wanted) == _words(wanted):
            return held.writer
        return AnswerWriter(WorldLanguage.of(world))

    def _oracle(
        self, world: World, wanted: WantedAnswerer, held: LoadedParser | None
    ) -> LoadedParser | None:
        """Return the oracle of a world as it is now; None where there are no templates that can be read."""
        knowledge = wanted.knowledge(Protocol.GRAMMAR)
        if held is not None and held.knowledge == knowledge:
            return held
        try:
            return self._hold(make_untrained(ORACLE, world), knowledge)
        except LanguageError as error:
            logger.warning("The oracle of %s cannot read its grammar: %s", world.name, error)
        except Refusal:  # there is no template
            pass
        return None

    def _learned(
        self,
        name: str,
        wanted: WantedAnswerer,
        run: int,
        held: LoadedParser | None,
        any_parser: bool = False,
        is_last: bool = False,
    ) -> LoadedParser | None:
        """Load the parser of a run; None for one that learns nothing, such as an oracle of another day, unless
        ``any_parser`` is asked for. The last part is waited for a shorter time, since a question waits behind it."""
        of_world = TrainingRun.objects.select_related("world").filter(world=wanted.world)
        row = of_world.filter(pk=run).first()
        if row is None:
            raise Refusal(f"There is no run {run} in {name}.", "no_such_run", HTTPStatus.CONFLICT)
        if row.parser in untrained() and not any_parser:
            return None
        knowledge = wanted.knowledge(row.protocol)
        if held is not None and (held.run, held.knowledge) == (row.pk, knowledge):
            return held
        parser, patience = load_anew(row).hesitant(), self._patience
        if is_last and math.isfinite(patience):
            parser, patience = parser.once(), patience * LAST_SHARE
        return self._hold(parser, knowledge, row.pk, size_of(row), patience)

    def _hold(
        self,
        parser: Parser,
        knowledge: tuple[object, ...],
        run: int | None = None,
        size: int = 0,
        patience: float = PATIENCE,
    ) -> LoadedParser:
        return LoadedParser(
            run=run,
            name=parser.name,
            score_kind=str(parser.score_kind or ""),
            knowledge=knowledge,
            size=size,
            batcher=RemoteAsker(parser.predict, self._seats, patience)
            if parser.asks_a_server
            else Batcher(parser.predict, self._turn, self.metrics.batches.observe),
            lines_together=TOGETHER if parser.asks_a_server else LINES_TOGETHER,
            parser=parser,
        )


def _stopping(writer: AnswerWriter) -> StoppingWords:
    """Return what finds the words that nobody knows."""
    return StoppingWords(writer.language.ontology, writer.language.use.vocabulary)


def _reader(writer: AnswerWriter, oracle: LoadedParser | None) -> HearingReader:
    """Return what hears utterances without their noise, by the words of the oracle where there is one."""
    if oracle is not None and isinstance(oracle.parser, GrammarOracle):
        return oracle.parser.reader
    return HearingReader(writer.language.ontology, writer.language.use.vocabulary)


def _world(name: str, wanted: WantedAnswerer) -> World:
    """Return the row of a world. Raises Refusal where it is gone since it was looked for."""
    world = World.objects.present().filter(pk=wanted.world).first()
    if world is None:
        raise Refusal(f"There is no world {name}.", "no_such_world", HTTPStatus.NOT_FOUND)
    return world


def _words(wanted: WantedAnswerer) -> tuple[object, ...]:
    """Return what changes when the language of the world has to be read anew."""
    return wanted.language, wanted.revision, wanted.names, wanted.recipes


def _nobody_answers(world: str, wanted: WantedAnswerer) -> str:
    """Return why nothing answers in a world, and what there is to do."""
    sentence = f"{world} has no templates, and no run of it has been promoted yet, so nothing answers there."
    if TrainingRun.objects.active().filter(world=wanted.world).exists():
        return (
            f"{sentence} Parsers are being trained there; the first that is right on paraphrases will "
            "answer by itself. Ask again later."
        )
    return f"{sentence} Write templates, train a parser on paraphrases, or promote one."
