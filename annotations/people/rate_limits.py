"""How often somebody may try something."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

from django.core.cache import cache


@dataclass(frozen=True, slots=True)
class Rate:
    """At most ``limit`` events within ``seconds`` for each key, over all processes of the site.

    Each event occupies a place in the shared cache until it expires. Taking a place is one atomic
    step, so that events at the same time cannot share one.
    """

    name: str
    limit: int
    seconds: int

    def left(self, key: str) -> int:
        """Return how many events ``key`` has left for now."""
        return self.limit - len(cache.get_many(self._places(key)))

    def take(self, key: str) -> str | None:
        """Count one event of ``key`` and return its place; None where none is left."""
        places = self._places(key)
        taken = cache.get_many(places)
        for place in places:
            if place not in taken and cache.add(place, 1, self.seconds):
                return place
        return None

    def give_back(self, place: str) -> None:
        """Undo a ``take``."""
        cache.delete(place)

    def forget(self, key: str) -> None:
        """Let ``key`` start anew."""
        cache.delete_many(self._places(key))

    def _places(self, key: str) -> list[str]:
        digest = hashlib.sha256(key.encode("utf-8", "surrogatepass")).hexdigest()
        return [f"{self.name}:{digest}:{number}" for number in range(self.limit)]


# Attempts from one address; joining gives its place back.
JOINING = Rate("join", limit=20, seconds=600)
STARTED_RUNS = Rate("runs", limit=60, seconds=3600)
