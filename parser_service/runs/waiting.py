"""Estimates how long a queued run will wait and then train, from earlier runs."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import median

from django.db.models import Q
from django.utils import timezone

from annotations.background import kinds
from annotations.showing.figures import rough_duration
from parser_service.models import TrainingRun, Worker

COUNTED = 20  # the newest runs of a parser that its usual time is taken from


@dataclass(frozen=True, slots=True)
class ExpectedWait:
    """The place of a queued run. Seconds are None where no earlier run tells them.

    ``ahead`` counts runs and jobs of its queue that began or wait for longer; ``starts_in`` is until a
    worker takes it, ``takes`` how long it then takes.
    """

    ahead: int
    workers: int
    starts_in: float | None
    takes: float | None

    @property
    def sentence(self) -> str:
        if not self.workers:
            place = "No worker takes it now; it starts when one does."
        elif not self.ahead:
            place = "Next in line."
        elif self.starts_in is None:
            place = f"{self.ahead} ahead of it."
        else:
            place = (
                f"{self.ahead} ahead of it; likely to start in {rough_duration(self.starts_in)}."
            )
        parts = [place]
        if self.takes is not None:
            parts.append(f"It takes {rough_duration(self.takes)}, by earlier runs of this parser.")
        return " ".join(parts)


def waiting_of(run: TrainingRun) -> ExpectedWait:
    """Return the place of ``run``, which is queued, and the likely times."""
    before = Q(status="running") | Q(
        Q(queued_at__lt=run.queued_at) | Q(queued_at=run.queued_at, id__lt=run.pk), status="queued"
    )
    ahead = {
        kind: list(kind.objects.active().filter(before, queue=run.queue))
        for kind in kinds()
        if kind is not TrainingRun
    }
    runs = TrainingRun.objects.active().filter(before, queue=run.queue)
    workers = Worker.objects.alive_by_queue()[run.queue]
    left = [_seconds_left(each) for each in runs]
    known = [seconds for seconds in left if seconds is not None]
    is_known = not any(ahead.values()) and len(known) == len(left)
    return ExpectedWait(
        ahead=len(left) + sum(map(len, ahead.values())),
        workers=workers,
        starts_in=sum(known) / workers if is_known and workers else None,
        takes=usual_seconds(run),
    )


def usual_seconds(run: TrainingRun) -> float | None:
    """Return the median time of the newest uninterrupted runs like ``run``, evaluation included.

    These are runs of the same parser on the same share of the training pairs, with the same
    hyperparameters if there are any such.
    """
    of_parser = TrainingRun.objects.succeeded().filter(
        parser=run.parser, train_share=run.train_share, attempt=1
    )
    for ended in (of_parser.filter(config=run.config), of_parser):
        times = ended.order_by("-id").values_list("started_at", "finished_at")[:COUNTED]
        seconds = [
            (finished - started).total_seconds()
            for started, finished in times
            if started and finished
        ]
        if seconds:
            return median(seconds)
    return None


def _seconds_left(run: TrainingRun) -> float | None:
    """Estimate the seconds that a queued or running run still needs."""
    usual = usual_seconds(run)
    if run.started_at is None or run.status != "running":
        return usual
    if (left := run.seconds_left) is not None:
        return left
    passed = (timezone.now() - run.started_at).total_seconds()
    return None if usual is None else max(usual - passed, 0.0)
