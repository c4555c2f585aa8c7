"""What answers in a world where nobody names a parser: its parts, and the choice between them."""

from __future__ import annotations

from dataclasses import dataclass
from http import HTTPStatus

from django.db import IntegrityError, transaction
from django.utils import timezone

from annotations.language.errors import Refusal
from annotations.models import User, World
from annotations.rows.from_rows import ready_templates
from parser_service.models import Answering, AnsweringOrder, TrainingRun
from parser_service.models.answering import MOST_ALLOWED_WRONG, answering_of
from parser_service.parsers.registry import ORACLE, title_of
from parser_service.promotions.promoting import learned_part


@dataclass(frozen=True, slots=True)
class AnsweringParts:
    """Which parts a world asks, as the parse server takes them: the grammar oracle, then the parser of ``run``."""

    has_oracle: bool = False
    run: TrainingRun | None = None

    def __bool__(self) -> bool:
        return self.has_oracle or self.run is not None

    @property
    def titles(self) -> tuple[str, ...]:
        """What pages call the parts, in the order in which they are asked."""
        oracle = (title_of(ORACLE),) if self.has_oracle else ()
        return (*oracle, f"run {self.run.pk}, {title_of(self.run.parser)}") if self.run else oracle

    @property
    def in_words(self) -> str:
        return ", then ".join(self.titles)


def answering_parts(world: World) -> AnsweringParts:
    """Return the parts that answer in ``world`` now; none where it has neither templates nor a promoted run."""
    order = answering_of(world).order
    run = None if order == AnsweringOrder.ORACLE else learned_part(world)
    is_asked = order != AnsweringOrder.LEARNED or run is None
    return AnsweringParts(is_asked and ready_templates(world).exists(), run)


def version_of(row: Answering) -> int:
    """Return the version of the choices of a world; 0 where nobody has made any."""
    return row.version if row.pk else 0


def choose_answering(
    world: World, order: str, allowed_wrong: float, by: User, version: int
) -> Answering:
    """Choose which parts answer in ``world``, and the share of wrong acts that is allowed, a fraction of 1.

    ``version`` is that of the choices that ``by`` has seen (``version_of``). Raises Refusal where they have changed
    since, and for values that cannot be.
    """
    if order not in AnsweringOrder.values:
        orders = ", ".join(AnsweringOrder.values)
        raise Refusal(f"The order “{order[:20]}” is none of {orders}.", "no_such_order")
    if not 0 <= allowed_wrong <= MOST_ALLOWED_WRONG:
        sentence = f"Between 0 and {MOST_ALLOWED_WRONG:.0%} of the acts may be allowed to be wrong."
        raise Refusal(sentence, "share_out_of_range")
    values = {
        "order": order,
        "allowed_wrong": allowed_wrong,
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
