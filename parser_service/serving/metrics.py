"""What the parse server counts, in the text format of Prometheus."""

from __future__ import annotations

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest

SECONDS = (0.005, 0.01, 0.02, 0.03, 0.04, 0.06, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
SIZES = (1, 2, 4, 8, 16, 32, 64)


class Metrics:
    """The counters of one server; several in one process keep apart."""

    def __init__(self) -> None:
        self._registry = CollectorRegistry()
        self.requests = Counter(
            "gpsr_parse_requests",
            "Requests to parse, by world and status.",
            ["world", "status"],
            registry=self._registry,
        )
        self.utterances = Counter(
            "gpsr_parse_utterances", "Utterances parsed.", ["world"], registry=self._registry
        )
        self.seconds = Histogram(
            "gpsr_parse_seconds",
            "Seconds from a request for one utterance to its answer.",
            buckets=SECONDS,
            registry=self._registry,
        )
        self.batches = Histogram(
            "gpsr_parse_batch_size",
            "Utterances that a parser answered together.",
            buckets=SIZES,
            registry=self._registry,
        )
        self.parsers = Gauge("gpsr_parsers_loaded", "Parsers in memory.", registry=self._registry)
        self.changes = Counter(
            "gpsr_parser_changes",
            "How often another run began to answer.",
            ["world"],
            registry=self._registry,
        )

    def as_text(self) -> bytes:
        return generate_latest(self._registry)
