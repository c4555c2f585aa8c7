"""Whether anybody trains: what the top bar and the banner of every page say."""

from __future__ import annotations

from dataclasses import dataclass

from parser_service.models import TrainingRun, Worker


@dataclass(frozen=True, slots=True)
class Workers:
    """How many workers are alive, and the runs that they have and that wait, over all worlds."""

    alive: int
    running: int
    queued: int

    @property
    def is_alive(self) -> bool:
        return self.alive > 0

    @property
    def summary(self) -> str:
        """The state in two or three words, for the top bar."""
        waiting = f", {self.queued} waiting" if self.queued else ""
        if not self.alive:
            return f"No worker{waiting}"
        return f"{self.running} training{waiting}" if self.running else f"Worker idle{waiting}"

    @property
    def sentence(self) -> str:
        """What is wrong, for the banner; empty where all is well."""
        waiting = self.queued + self.running
        if self.alive:
            return ""
        if not waiting:
            return "A run that is started now would wait."
        return f"{waiting} {'run waits' if waiting == 1 else 'runs wait'} for one."


def workers_now() -> Workers:
    """The state now: one count of workers and two of runs."""
    runs = TrainingRun.objects
    return Workers(
        alive=Worker.objects.alive().count(),
        running=runs.running().count(),
        queued=runs.queued().count(),
    )
