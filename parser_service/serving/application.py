"""The parse server's answers over HTTP, as a WSGI application.

``POST /api/v1/worlds/<w>/parse/`` takes one JSON object, or JSON lines where the content type says so;
``GET /healthz``, ``/metrics`` and ``/api/v1/parsers/`` say how it does. All but ``/healthz`` need the
secret that the site and the server share.
"""

from __future__ import annotations

import hmac
import logging
import re
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from prometheus_client import CONTENT_TYPE_LATEST

from annotations.language.texts import Refusal
from parser_service.parsers.registry import untrained
from parser_service.serving.answerer import USUAL_BEAM, Answerer, NotServed
from parser_service.serving.lines import answer_lines, read_object
from parser_service.serving.parse_answers import as_json
from parser_service.serving.preparing import (
    MOST_ALTERNATIVES,
    require_beam,
    require_utterance,
)
from parser_service.serving.shelf import Shelf

logger = logging.getLogger(__name__)

JSON, JSON_LINES = "application/json", "application/jsonl"
PARSE_ADDRESS = re.compile(r"^/api/v1/worlds/(?P<world>[a-z0-9][a-z0-9_-]*)/parse/$")
LOADING_PATIENCE = 20.0  # seconds that a request waits for a parser that is being loaded

REASONS = {
    200: "OK",
    400: "Bad Request",
    401: "Unauthorized",
    404: "Not Found",
    405: "Method Not Allowed",
    409: "Conflict",
    500: "Internal Server Error",
    503: "Service Unavailable",
}
Environment = dict[str, Any]
StartResponse = Callable[[str, list[tuple[str, str]]], object]


class ParseApplication:
    """Answers requests with what is on the ``shelf``. ``close`` is called in the thread of a request when
    it is over."""

    def __init__(self, shelf: Shelf, secret: str, close: Callable[[], object]) -> None:
        self._shelf = shelf
        self._expected = f"Bearer {secret}".encode()
        self._close = close

    def __call__(self, environ: Environment, start_response: StartResponse) -> Iterable[bytes]:
        try:
            return self._route(environ, start_response)
        except NotServed as error:
            return _send_json(
                start_response, error.status, {"code": error.code, "detail": error.message}
            )
        except Exception:
            logger.exception("%s %s", environ["REQUEST_METHOD"], environ["PATH_INFO"])
            sentence = "The parser failed. The log of the parse server says why."
            return _send_json(start_response, 500, {"code": "parser_failed", "detail": sentence})
        finally:
            self._close()

    def _route(self, environ: Environment, start_response: StartResponse) -> Iterable[bytes]:
        method, path = environ["REQUEST_METHOD"], environ["PATH_INFO"]
        if path == "/healthz":
            status = "ok" if self._shelf.is_ready else "loading"
            return _send_json(start_response, 200, {"status": status})
        sent = environ.get("HTTP_AUTHORIZATION", "").encode("latin-1")
        if not hmac.compare_digest(sent, self._expected):
            raise NotServed(
                401, "The parse server and whoever asks it do not share a secret.", "other_secret"
            )
        if path == "/metrics":
            return _send(start_response, 200, CONTENT_TYPE_LATEST, self._shelf.metrics.as_text())
        if path == "/api/v1/parsers/":
            return _send_json(start_response, 200, self._shelf.describe())
        address = PARSE_ADDRESS.match(path)
        if address is None:
            raise NotServed(404, f"There is nothing at {path}.", "not_found")
        if method != "POST":
            raise NotServed(405, "Send a POST with an utterance.", "method_not_allowed")
        body = environ["wsgi.input"].read(int(environ.get("CONTENT_LENGTH") or 0))
        if environ.get("CONTENT_TYPE", "").startswith(JSON_LINES):
            return self._parse_lines(address["world"], environ, body, start_response)
        return self._parse_one(address["world"], body, start_response)

    def _parse_one(self, world: str, body: bytes, start_response: StartResponse) -> Iterable[bytes]:
        began = time.perf_counter()
        try:
            asked = read_object(body)
            utterances = _utterances(asked)
            beam = require_beam(asked.get("beam", USUAL_BEAM))
            answerer = self._find(world, asked.get("run"), asked.get("parser", ""))
            answer = answerer.write(answerer.ask_best(utterances, beam))
        except NotServed as error:
            self._count(world if error.status != 404 else "", error.status)
            raise
        except Refusal as error:
            self._count("", 400)
            raise NotServed(400, error.message, error.code) from error
        self._count(world, 200)
        self._shelf.metrics.utterances.labels(world=world).inc()
        self._shelf.metrics.seconds.observe(time.perf_counter() - began)
        return _send(start_response, 200, JSON, _encode(answer))

    def _parse_lines(
        self, world: str, environ: Environment, body: bytes, start_response: StartResponse
    ) -> Iterable[bytes]:
        """Answer each line in order, all with the parser that answers now."""
        query = dict(
            part.partition("=")[::2] for part in environ.get("QUERY_STRING", "").split("&") if part
        )
        try:
            run = int(query["run"]) if "run" in query else None
            beam = require_beam(int(query.get("beam", USUAL_BEAM)))
        except Refusal as error:
            sentence = f"run and beam are whole numbers. {error.message}"
            raise NotServed(400, sentence, error.code) from error
        except ValueError:
            raise NotServed(400, "run and beam are whole numbers.", "run_unreadable") from None
        answerer = self._find(world, run, query.get("parser", ""))
        self._count(world, 200)
        headers = [("Content-Type", JSON_LINES)]
        start_response(f"200 {REASONS[200]}", headers)
        return self._answer_lines(answerer, body, beam)

    def _answer_lines(self, answerer: Answerer, body: bytes, beam: int) -> Iterator[bytes]:
        for answers in answer_lines(answerer, body, beam):
            yield _encode("".join(f"{answer}\n" for answer in answers))
            self._shelf.metrics.utterances.labels(world=answerer.world).inc(len(answers))

    def _find(self, world: str, run: object, parser: object) -> Answerer:
        if run is not None and (not isinstance(run, int) or isinstance(run, bool)):
            raise NotServed(400, "run has to be the number of a run.", "run_unreadable")
        if parser not in ("", *untrained()):
            known = ", ".join(untrained())
            raise NotServed(
                400, f"parser has to be one that needs no run: {known}.", "unknown_parser"
            )
        if run is not None and parser:
            raise NotServed(400, "Name a run or a parser, not both.", "run_and_parser")
        return self._shelf.find(world, run, LOADING_PATIENCE, str(parser))

    def _count(self, world: str, status: int) -> None:
        self._shelf.metrics.requests.labels(world=world, status=str(status)).inc()


def _utterances(asked: dict[str, Any]) -> list[tuple[str, float]]:
    """Return the utterance of a request, or the alternatives of a recogniser, each with its score. Raises Refusal."""
    alternatives = asked.get("alternatives")
    if not alternatives:
        return [(require_utterance(asked.get("utterance")), 0.0)]
    try:
        offered = [(each["utterance"], float(each["score"])) for each in alternatives]
    except (KeyError, TypeError, ValueError) as error:
        raise Refusal(
            "alternatives have to be objects with an utterance and a score.", "bad_alternatives"
        ) from error
    return [(require_utterance(text), score) for text, score in offered[:MOST_ALTERNATIVES]]


def _encode(text: str) -> bytes:
    return text.encode("utf-8", "backslashreplace")  # half a character as JSON writes it


def _send_json(start_response: StartResponse, status: int, value: object) -> list[bytes]:
    return _send(start_response, status, JSON, _encode(as_json(value)))


def _send(start_response: StartResponse, status: int, kind: str, body: bytes) -> list[bytes]:
    headers = [("Content-Type", kind), ("Content-Length", str(len(body)))]
    start_response(f"{status} {REASONS[status]}", headers)
    return [body]
