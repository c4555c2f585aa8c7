"""Ask a server many questions at once, patiently, and only those that it has not answered yet."""

from __future__ import annotations

import logging
import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from functools import partial
from http import HTTPStatus
from typing import Any, TypeVar

from parser_service.parsers.interface import Check
from parser_service.parsers.model_server.crew import Crew
from parser_service.parsers.model_server.exchange import NoAnswer, NoReply, Reply, ServerRefusal
from parser_service.parsers.model_server.kept_answers import KeptAnswers, hash_of
from parser_service.parsers.model_server.protocol import (
    CHAT,
    MODELS,
    SCHEMA_FIELD,
    Dialect,
    ModelAnswer,
    Question,
    detail_of,
    is_model_of,
    read_answer,
    read_models,
)
from parser_service.parsers.server_address import ModelServer, problem_of

logger = logging.getLogger(__name__)

BUSY = (408, 409, 425, 429)  # statuses below 500 that pass
NOT_UNDERSTOOD = (400, 415, 422, 501)  # how servers refuse a field that they do not know
NO_LIST = (404, 405, 501)  # of models
JITTER = 0.5  # a pause is up to this share shorter: several askers do not come back together
MOST_LISTED = 10  # names of models in a sentence
T = TypeVar("T")


class Asker:
    """Asks one server. Each answer is kept as soon as it came, and never asked for again."""

    def __init__(self, server: ModelServer, at_once: int) -> None:
        self.server = server
        self.dialect = Dialect()
        self._answers = KeptAnswers(server.answers)
        self._at_once = at_once
        self._known_models: set[str] = set()

    def ask(self, questions: Sequence[Question], check: Check) -> list[ModelAnswer]:
        """Return the answer to each question, all or none.

        Raises ServerRefusal, a sentence, where one of them cannot be had, and what ``check`` raises, which is
        called several times a second.
        """
        answers = []
        for answer in self._answers_to(questions, check, self._ask):
            if isinstance(answer, NoAnswer):
                raise answer
            answers.append(answer)
        return answers

    def ask_each(self, questions: Sequence[Question], check: Check) -> list[ModelAnswer | NoAnswer]:
        """Return the answer to each question, or why there is none.

        Raises ServerRefusal where the server answers nobody, and what ``check`` raises.
        """
        return self._answers_to(questions, check, self._ask_or_say_why)

    def _answers_to(
        self,
        questions: Sequence[Question],
        check: Check,
        ask: Callable[[Question, Crew[ModelAnswer | NoAnswer]], ModelAnswer | NoAnswer],
    ) -> list[ModelAnswer | NoAnswer]:
        check()
        by_hash = {hash_of(each): each for each in questions}
        answers: dict[str, ModelAnswer | NoAnswer] = {
            name: answer for name, each in by_hash.items() if (answer := self._answers.find(each))
        }
        missing = [name for name in by_hash if name not in answers]
        if missing:
            self._require_model(questions[0].model, check)
            crew = Crew[ModelAnswer | NoAnswer](self.server, self._at_once, check)
            jobs = [partial(ask, by_hash[name]) for name in missing]
            answers |= zip(missing, crew.run(jobs), strict=True)
        return [answers[hash_of(each)] for each in questions]

    def _ask_or_say_why(self, question: Question, crew: Crew[Any]) -> ModelAnswer | NoAnswer:
        try:
            return self._ask(question, crew)
        except NoAnswer as error:
            return error

    def _ask(self, question: Question, crew: Crew[Any]) -> ModelAnswer:
        def attempt() -> ModelAnswer:
            reply = self._send(question, crew)
            self._require_success(reply)
            return read_answer(reply, self.server.key)

        answer = self._patiently(attempt, crew)
        named = answer if answer.model else replace(answer, model=question.model)
        self._answers.keep(question, named)
        return named

    def _send(self, question: Question, crew: Crew[Any]) -> Reply:
        """Send a question, in other words where the server does not understand the first ones."""
        sent = self.dialect.write(question)
        reply = crew.send("POST", CHAT, sent)
        detail = detail_of(reply, self.server.key)
        # llama-cpp-python calls a field that it does not understand a fault of its own (500).
        is_refused = reply.status in NOT_UNDERSTOOD or SCHEMA_FIELD in detail
        if reply.status == HTTPStatus.OK or not is_refused:
            return reply
        self.dialect.learn(detail)
        if (again := self.dialect.write(question)) != sent:
            reply = crew.send("POST", CHAT, again)
        if reply.status != HTTPStatus.OK and question.schema is not None:
            plainly = replace(self.dialect, takes_schema=False)
            without = crew.send("POST", CHAT, plainly.write(question))
            if without.status == HTTPStatus.OK:
                known = len(self.dialect.learned)
                self.dialect.forget_schema(detail)
                for sentence in self.dialect.learned[known:]:
                    logger.warning("%s", sentence)
                return without
        return reply

    def _require_model(self, name: str, check: Check) -> None:
        """Raise ServerRefusal where there is no server, or it lists its models and has none of this name: some
        answer with another one instead."""
        if name in self._known_models:
            return
        if problem := problem_of(self.server):
            raise ServerRefusal(problem)
        crew = Crew["list[str] | None"](self.server, 1, check)
        (listed,) = crew.run([self._list_models])
        if listed is not None and not is_model_of(name, listed):
            known = ", ".join(listed[:MOST_LISTED]) or "none"
            raise ServerRefusal(
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

    def _patiently(self, attempt: Callable[[], T], crew: Crew[Any]) -> T:
        """Return what an attempt returns; after NoReply try again, later and later. Raises ServerRefusal."""
        patience, name = self.server.patience, self.server.name
        words = ""
        for number in range(patience.tries):
            try:
                return attempt()
            except NoReply as error:
                words, wanted = str(error), error.after
            if wanted is not None and wanted > patience.longest_pause:
                raise ServerRefusal(
                    f"The language model's server at {name} wants to be asked again in {wanted:,.0f} s only "
                    f"({words}). Answers that came are kept: ask again then."
                )
            if number + 1 < patience.tries:
                doubled = min(patience.first_pause * 2**number, patience.longest_pause)
                crew.pause(doubled * (1 - JITTER * random.random()) if wanted is None else wanted)
        raise NoAnswer(
            f"The language model's server at {name} does not answer: {words}. It was asked "
            f"{patience.tries} times. Answers that came are kept: ask again when it is well."
        )

    def _require_success(self, reply: Reply) -> None:
        """Raise NoReply for a status that may pass, and ServerRefusal for one that will not."""
        if reply.status == HTTPStatus.OK:
            return
        detail = detail_of(reply, self.server.key)
        said = f"status {reply.status}{detail and f', {detail}'}"
        if reply.status in BUSY or reply.status >= 500:
            raise NoReply(said, _retry_after(reply))
        server = f"The language model's server at {self.server.name}"
        if reply.status in (401, 403):
            raise ServerRefusal(
                f"{server} does not let us in ({said}). Set GPSR_LLM_KEY to its key."
            )
        if reply.status == 404:
            raise ServerRefusal(
                f"{server} has nothing at {self.server.path}{CHAT} ({said}). Look at GPSR_LLM_URL, which "
                "often ends in /v1, and at the name of the model."
            )
        raise NoAnswer(f"{server} refuses the question ({said}).")


def _retry_after(reply: Reply) -> float | None:
    """Return the seconds that a server wants to be left alone: a number or a date (RFC 9110, 10.2.3)."""
    text = reply.headers.get("retry-after", "").strip()
    if text.isdecimal():
        return float(text)
    try:
        then = parsedate_to_datetime(text)
    except (TypeError, ValueError, OverflowError):  # the last of a year that no calendar has
        return None
    left = (then if then.tzinfo else then.replace(tzinfo=UTC)) - datetime.now(UTC)
    return max(0.0, left.total_seconds())
