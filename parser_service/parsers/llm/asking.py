"""Ask a server many questions at once, patiently, and only those that it has not answered yet."""

from __future__ import annotations

import logging
import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from http import HTTPStatus
from typing import TypeVar

from parser_service.parsers.interface import Check
from parser_service.parsers.llm.answers import Answers, hash_of
from parser_service.parsers.llm.crew import Crew
from parser_service.parsers.llm.exchange import NoReply, Refused, Reply
from parser_service.parsers.llm.places import Server, problem_of
from parser_service.parsers.llm.protocol import (
    CHAT,
    MODELS,
    Answer,
    Dialect,
    Question,
    detail_of,
    is_model_of,
    read_answer,
    read_models,
)

logger = logging.getLogger(__name__)

BUSY = (408, 409, 425, 429)  # statuses below 500 that pass
NOT_UNDERSTOOD = (400, 415, 422, 501)  # how servers refuse a field that they do not know
NO_LIST = (404, 405, 501)  # of models
JITTER = 0.5  # a pause is up to this share shorter: several askers do not come back together
MOST_LISTED = 10  # names of models in a sentence
T = TypeVar("T")


class Asker:
    """Asks one server. Each answer is kept as soon as it came, and never asked for again."""

    def __init__(self, server: Server, at_once: int) -> None:
        self.server = server
        self.dialect = Dialect()
        self._answers = Answers(server.answers)
        self._at_once = at_once
        self._known_models: set[str] = set()

    def ask(self, questions: Sequence[Question], check: Check) -> list[Answer]:
        """Return the answer to each question, all or none.

        Raises Refused, a sentence, where one of them cannot be had, and what ``check`` raises, which is
        called several times a second.
        """
        check()
        by_hash = {hash_of(each): each for each in questions}
        answers = {name: self._answers.find(each) for name, each in by_hash.items()}
        missing = {name: by_hash[name] for name, answer in answers.items() if answer is None}
        if missing:
            self._require_model(questions[0].model, check)
            crew = Crew[Answer](self.server, self._at_once, check)
            answers |= zip(
                missing, crew.run([self._job(each) for each in missing.values()]), strict=True
            )
        return [answer for each in questions if (answer := answers[hash_of(each)]) is not None]

    def _job(self, question: Question) -> Callable[[Crew[Answer]], Answer]:
        return lambda crew: self._ask(question, crew)

    def _ask(self, question: Question, crew: Crew[Answer]) -> Answer:
        def attempt() -> Answer:
            reply = self._send(question, crew)
            self._require_success(reply)
            return read_answer(reply, self.server.key)

        answer = self._patiently(attempt, crew)
        named = answer if answer.model else replace(answer, model=question.model)
        self._answers.keep(question, named)
        return named

    def _send(self, question: Question, crew: Crew[Answer]) -> Reply:
        """Send a question, in other words where the server does not understand the first ones."""
        sent = self.dialect.write(question)
        reply = crew.send("POST", CHAT, sent)
        if reply.status not in NOT_UNDERSTOOD:
            return reply
        detail = detail_of(reply, self.server.key)
        self.dialect.learn(detail)
        if (again := self.dialect.write(question)) != sent:
            reply = crew.send("POST", CHAT, again)
        if reply.status in NOT_UNDERSTOOD and question.schema is not None:
            plainly = replace(self.dialect, takes_schema=False)
            without = crew.send("POST", CHAT, plainly.write(question))
            if without.status == HTTPStatus.OK:
                self._forget_schema(detail)
                return without
        return reply

    def _forget_schema(self, detail: str) -> None:
        known = len(self.dialect.learned)
        self.dialect.forget_schema(detail)
        for sentence in self.dialect.learned[known:]:
            logger.warning("%s", sentence)

    def _require_model(self, name: str, check: Check) -> None:
        """Raise Refused where there is no server, or it lists its models and has none of this name: some
        answer with another one instead."""
        if name in self._known_models:
            return
        if problem := problem_of(self.server):
            raise Refused(problem)
        crew = Crew["list[str] | None"](self.server, 1, check)
        (listed,) = crew.run([self._list_models])
        if listed is not None and not is_model_of(name, listed):
            known = ", ".join(listed[:MOST_LISTED]) or "none"
            raise Refused(
                f"The server at {self.server.name} has no model {name!r}; it has: {known}."
            )
        self._known_models.add(name)

    def _list_models(self, crew: Crew[list[str] | None]) -> list[str] | None:
        def attempt() -> list[str] | None:
            reply = crew.send("GET", MODELS)
            if reply.status not in NO_LIST:
                self._require_success(reply)
            return read_models(reply, self.server.key)

        return self._patiently(attempt, crew)

    def _patiently(self, attempt: Callable[[], T], crew: Crew[T]) -> T:
        """Return what an attempt returns; after NoReply try again, later and later. Raises Refused."""
        patience, name = self.server.patience, self.server.name
        words = ""
        for number in range(patience.tries):
            try:
                return attempt()
            except NoReply as error:
                words, wanted = str(error), error.after
            if wanted is not None and wanted > patience.longest_pause:
                raise Refused(
                    f"The language model's server at {name} wants to be asked again in {wanted:,.0f} s only "
                    f"({words}). Answers that came are kept: ask again then."
                )
            if number + 1 < patience.tries:
                doubled = min(patience.first_pause * 2**number, patience.longest_pause)
                crew.pause(_with_jitter(doubled) if wanted is None else wanted)
        raise Refused(
            f"The language model's server at {name} does not answer: {words}. It was asked "
            f"{patience.tries} times. Answers that came are kept: ask again when it is well."
        )

    def _require_success(self, reply: Reply) -> None:
        """Raise NoReply for a status that may pass, and Refused for one that will not."""
        if reply.status == HTTPStatus.OK:
            return
        detail = detail_of(reply, self.server.key)
        said = f"status {reply.status}{detail and f', {detail}'}"
        if reply.status in BUSY or reply.status >= 500:
            raise NoReply(said, _retry_after(reply))
        server = f"The language model's server at {self.server.name}"
        if reply.status in (401, 403):
            raise Refused(f"{server} does not let us in ({said}). Set GPSR_LLM_KEY to its key.")
        if reply.status == 404:
            raise Refused(
                f"{server} has nothing at {self.server.path}{CHAT} ({said}). Look at GPSR_LLM_URL, which "
                "often ends in /v1, and at the name of the model."
            )
        raise Refused(f"{server} refuses the question ({said}).")


def _with_jitter(seconds: float) -> float:
    return seconds * (1 - JITTER * random.random())


def _retry_after(reply: Reply) -> float | None:
    """Return the seconds that a server wants to be left alone: a number or a date (RFC 9110, 10.2.3)."""
    text = reply.headers.get("retry-after", "").strip()
    if text.isdecimal():
        return float(text)
    try:
        then = parsedate_to_datetime(text)
    except (TypeError, ValueError):
        return None
    left = (then if then.tzinfo else then.replace(tzinfo=UTC)) - datetime.now(UTC)
    return max(0.0, left.total_seconds())
