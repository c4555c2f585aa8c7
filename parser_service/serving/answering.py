"""What answers in a world where nobody names a parser: its parts, and the choice between them."""

from __future__ import annotations

from dataclasses import dataclass
from http import HTTPStatus

from django.db import IntegrityError, transaction
from django.utils import timezone

from annotations.language.texts import Refusal
from annotations.models import User, World
from annotations.rows.from_rows import ready_templates
from parser_service.models import Answering, AnsweringOrder, TrainingRun
from parser_service.models.answering import MOST_ALLOWED_WRONG, answering_of
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.registry import ORACLE, Needs, needing, title_of
from parser_service.parsers.server_address import problem_of, server
from parser_service.runs.promoting import last_part, last_runs, learned_part
from parser_service.serving.calibrating import Calibrated, calibrated


@dataclass(frozen=True, slots=True)
class AnsweringParts:
    """Which parts a world asks, as the parse server takes them: the grammar oracle, then the parser of ``run``, then
    the language model of ``last``."""

    has_oracle: bool = False
    run: TrainingRun | None = None
    last: TrainingRun | None = None

    def __bool__(self) -> bool:
        return self.has_oracle or self.run is not None

    @property
    def titles(self) -> tuple[str, ...]:
        """What pages call the parts, in the order in which they are asked."""
        oracle = (title_of(ORACLE),) if self.has_oracle else ()
        return (*oracle, *(f"run {each.pk}, {title_of(each.parser)}" for each in self.runs))

    @property
    def runs(self) -> tuple[TrainingRun, ...]:
        """The runs among the parts, in the order in which they are asked."""
        return tuple(each for each in (self.run, self.last) if each)

    @property
    def in_words(self) -> str:
        return ", then ".join(self.titles)

    @property
    def in_short(self) -> str:
        """The parts with the runs by their numbers alone, for a field of one line."""
        oracle = (title_of(ORACLE),) if self.has_oracle else ()
        return ", then ".join((*oracle, *(f"run {each.pk}" for each in self.runs)))


def answering_parts(world: World) -> AnsweringParts:
    """Return the parts that answer in ``world`` now; none where it has neither templates nor a promoted run."""
    order = answering_of(world).order
    run = None if order == AnsweringOrder.ORACLE else learned_part(world)
    is_asked = order != AnsweringOrder.LEARNED or run is None
    has_oracle = is_asked and ready_templates(world).exists()
    last = last_part(world) if has_oracle or run else None
    return AnsweringParts(has_oracle, run, None if last == run else last)


def calibrated_parts(world: World, row: Answering, parts: AnsweringParts) -> Calibrated:
    """Return what was last measured of the answers of ``parts`` by the choices of ``row``."""
    run, last = (each.pk if each else None for each in (parts.run, parts.last))
    return calibrated(world, run, row.order, row.allowed_wrong, last)


def why_no_last_part(world: World) -> str:
    """Say what keeps a language model from being asked last in ``world``, and what to do; empty where nothing does."""
    if problem := problem_of(server()):
        return problem
    if last_runs().filter(world=world).exists():
        return ""
    titles = " or ".join(map(title_of, needing(Needs.SERVER)))
    return (
        f"No language model was tried in {world.name} yet. Start a run of {titles} under the protocol "
        f"{Protocol.DOMAIN}: it says which model, and checks that it answers."
    )


def version_of(row: Answering) -> int:
    """Return the version of the choices of a world; 0 where nobody has made any."""
    return row.version if row.pk else 0


def choose_answering(
    world: World,
    order: str,
    allowed_wrong: float,
    by: User,
    version: int,
    asks_language_model: bool = False,
) -> Answering:
    """Choose which parts answer in ``world``, whether a language model is asked last, and the share of wrong acts that
    is allowed, a fraction of 1.

    ``version`` is that of the choices that ``by`` has seen (``version_of``). Raises Refusal where they have changed
    since, for values that cannot be, and where a language model is to be asked that cannot.
    """
    if order not in AnsweringOrder.values:
        orders = ", ".join(AnsweringOrder.values)
        raise Refusal(f"The order “{order[:20]}” is none of {orders}.", "no_such_order")
    if not 0 <= allowed_wrong <= MOST_ALLOWED_WRONG:
        sentence = f"Between 0 and {MOST_ALLOWED_WRONG:.0%} of the acts may be allowed to be wrong."
        raise Refusal(sentence, "share_out_of_range")
    is_switched_on = asks_language_model and not answering_of(world).asks_language_model
    if is_switched_on and (problem := why_no_last_part(world)):
        raise Refusal(problem, "no_language_model", HTTPStatus.CONFLICT)
    values = {
        "order": order,
        "allowed_wrong": allowed_wrong,
        "asks_language_model": asks_language_model,
        "version": version + 1,
        "changed_by": by,
        "changed_at": timezone.now(),
    }
    rows = Answering.objects.filter(world=world, version=version)
    try:
        with transaction.atomic():
            if not version:
                return Answering.objects.create(world=world, **values)
            is_stored = bool(rows.update(**values))
    except IntegrityError:
        is_stored = False
    if not is_stored:
        sentence = "Somebody has changed what answers here meanwhile. Look at it again."
        raise Refusal(sentence, "answering_changed_meanwhile", HTTPStatus.CONFLICT)
    return answering_of(world)
