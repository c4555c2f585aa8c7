"""How often somebody may try: counters in the cache, forgotten after a while."""

from __future__ import annotations

from dataclasses import dataclass

from django.core.cache import cache


@dataclass(frozen=True, slots=True)
class Rate:
    """At most ``limit`` events in ``seconds`` for each key. Counted per web process."""

    name: str
    limit: int
    seconds: int

    def is_spent(self, key: str) -> bool:
        """Whether ``key`` has no event left for now."""
        return self.left(key) == 0

    def left(self, key: str) -> int:
        """How many events ``key`` has left for now."""
        return max(0, self.limit - int(cache.get(self._slot(key), 0)))

    def count(self, key: str) -> None:
        """One event of ``key``; the first one starts the clock."""
        if not cache.add(self._slot(key), 1, self.seconds):
            try:
                cache.incr(self._slot(key))
            except ValueError:  # it ran out between the two
                cache.add(self._slot(key), 1, self.seconds)

    def forget(self, key: str) -> None:
        """Start ``key`` anew."""
        cache.delete(self._slot(key))

    def _slot(self, key: str) -> str:
        return f"rate:{self.name}:{key.encode().hex()[:180]}"


FAILED_LOG_INS = Rate("log-in", limit=10, seconds=600)
STARTED_RUNS = Rate("runs", limit=60, seconds=3600)
