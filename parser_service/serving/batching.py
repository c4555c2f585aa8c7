"""Answer requests that wait for the same parser together."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from parser_service.parsers.interface import Candidate

Predict = Callable[[Sequence[str], int], list[list[Candidate]]]
MOST_TOGETHER = 64  # texts


@dataclass(eq=False, slots=True)
class _Request:
    texts: Sequence[str]
    beam: int
    answers: list[list[Candidate]] | None = None
    error: Exception | None = field(default=None)

    @property
    def is_answered(self) -> bool:
        return self.answers is not None or self.error is not None


class Batcher:
    """Calls ``predict`` for several threads at once: whoever gets the turn answers all that wait by then.

    A request is answered by one call, and by this parser alone. ``turn`` is shared by the parsers of a
    process, so that they do not compete for its processors. ``observe`` hears the size of each call.
    """

    def __init__(
        self,
        predict: Predict,
        turn: threading.Lock,
        observe: Callable[[int], object] = lambda size: None,
    ) -> None:
        self._predict = predict
        self._turn = turn
        self._observe = observe
        self._guard = threading.Lock()
        self._waiting: list[_Request] = []

    def ask(self, texts: Sequence[str], beam: int) -> list[list[Candidate]]:
        """Return the candidates of each text. Raises what ``predict`` raises about these texts."""
        request = _Request(texts, beam)
        with self._guard:
            self._waiting.append(request)
        with self._turn:
            if not request.is_answered:
                self._answer(self._take_with(request))
        if request.error is not None:
            raise request.error
        assert request.answers is not None
        return request.answers

    def _take_with(self, first: _Request) -> list[_Request]:
        """Take ``first`` and those that fit beside it, the longest waiting before others."""
        with self._guard:
            taken, size = [first], len(first.texts)
            for other in self._waiting:
                fits = size + len(other.texts) <= MOST_TOGETHER
                if other is not first and other.beam == first.beam and fits:
                    taken.append(other)
                    size += len(other.texts)
            chosen = set(map(id, taken))
            self._waiting = [each for each in self._waiting if id(each) not in chosen]
        return taken

    def _answer(self, requests: Sequence[_Request]) -> None:
        """Answer all in one call; where that fails, each alone, so that none suffers from another."""
        texts = [text for request in requests for text in request.texts]
        try:
            answers = iter(self._predict(texts, requests[0].beam))
        except Exception as error:
            if len(requests) == 1:
                requests[0].error = error
                return
            for request in requests:
                self._answer([request])
            return
        self._observe(len(texts))
        for request in requests:
            request.answers = [next(answers) for _ in request.texts]
