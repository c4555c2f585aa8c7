"""Answer requests with a parser that itself waits for a server elsewhere."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from http import HTTPStatus

from annotations.language.texts import Refusal
from parser_service.parsers.interface import Candidate, Check

Predict = Callable[[Sequence[str], int, Check], list[list[Candidate]]]

# Below the 30 s that pages and REST wait for the parse server (``parser_client.PATIENCE``). Where nobody waits, as
# for the lines of a file on the command line or of a job, the server may take as long as it needs.
PATIENCE = 20.0
LAST_SHARE = 0.25  # of the patience, for a part behind which a question waits: 5 s
SEATS = 8  # requests that may wait for such parsers at once, of all threads of the parse server
TOGETHER = 4  # lines of a longer request, so that each part of it is answered within the patience


class Unanswered(Refusal):
    """The other server did not answer."""

    code = "language_model_away"
    status = HTTPStatus.SERVICE_UNAVAILABLE


class RemoteAsker:
    """Asks for each request alone, since nothing is computed here. It takes no turn from other parsers, and
    no more than the ``seats`` that such parsers share: threads that wait are threads that others lack."""

    def __init__(
        self, predict: Predict, seats: threading.BoundedSemaphore, patience: float = PATIENCE
    ) -> None:
        self._predict = predict
        self._seats = seats
        self._patience = patience

    def ask(self, texts: Sequence[str], beam: int) -> list[list[Candidate]]:
        """Return the candidates of each text. Raises Unanswered within the patience."""
        if not self._seats.acquire(blocking=False):
            raise Unanswered(
                f"{SEATS} others wait for a language model already. Ask again in a few seconds."
            )
        end = time.monotonic() + self._patience

        def check() -> None:
            if time.monotonic() > end:
                raise Unanswered(
                    f"The language model has not answered within {self._patience:g} s. Ask again: it may "
                    "only have been starting."
                )

        try:
            return self._predict(texts, beam, check)
        except Unanswered:
            raise
        except Refusal as error:
            raise Unanswered(error.message) from error
        finally:
            self._seats.release()
