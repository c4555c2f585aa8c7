"""The parse server's answers over HTTP, as a WSGI application.

``POST /api/v1/worlds/<w>/parse/`` takes one JSON object, or JSON lines where the content type says so;
``GET /healthz``, ``/metrics`` and ``/api/v1/parsers/`` say how it does. All but ``/healthz`` need the
secret that the site and the server share.
"""

from __future__ import annotations

import hmac
import json
import logging
import re
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from prometheus_client import CONTENT_TYPE_LATEST

from parser_service.serving.answers import as_json
from parser_service.serving.preparing import require_beam, require_utterance
from parser_service.serving.shelf import Asked, NotServed, Service, Shelf

logger = logging.getLogger(__name__)

JSON, JSON_LINES = "application/json", "application/jsonl"
PARSE_ADDRESS = re.compile(r"^/api/v1/worlds/(?P<world>[a-z0-9][a-z0-9_-]*)/parse/$")
USUAL_BEAM = 5
LOADING_PATIENCE = 20.0  # seconds that a request waits for a parser that is being loaded
FAILED = "the parser failed. The log of the parse server says why."

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


class Application:
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
            return _send_json(start_response, error.status, {"detail": str(error)})
        except Exception:
            logger.exception("%s %s", environ["REQUEST_METHOD"], environ["PATH_INFO"])
            sentence = "The parser failed. The log of the parse server says why."
            return _send_json(start_response, 500, {"detail": sentence})
        finally:
            self._close()

    def _route(self, environ: Environment, start_response: StartResponse) -> Iterable[bytes]:
        method, path = environ["REQUEST_METHOD"], environ["PATH_INFO"]
        if path == "/healthz":
            status = "ok" if self._shelf.is_ready else "loading"
            return _send_json(start_response, 200, {"status": status})
        self._require_secret(environ)
        if path == "/metrics":
            return _send(start_response, 200, CONTENT_TYPE_LATEST, self._shelf.metrics.as_text())
        if path == "/api/v1/parsers/":
            return _send_json(start_response, 200, self._shelf.describe())
        address = PARSE_ADDRESS.match(path)
        if address is None:
            raise NotServed(404, f"There is nothing at {path}.")
        if method != "POST":
            raise NotServed(405, "Send a POST with an utterance.")
        body = environ["wsgi.input"].read(int(environ.get("CONTENT_LENGTH") or 0))
        if environ.get("CONTENT_TYPE", "").startswith(JSON_LINES):
            return self._parse_lines(address["world"], environ, body, start_response)
        return self._parse_one(address["world"], body, start_response)

    def _require_secret(self, environ: Environment) -> None:
        sent = environ.get("HTTP_AUTHORIZATION", "").encode("latin-1")
        if not hmac.compare_digest(sent, self._expected):
            raise NotServed(401, "The parse server and whoever asks it do not share a secret.")

    def _parse_one(self, world: str, body: bytes, start_response: StartResponse) -> Iterable[bytes]:
        began = time.perf_counter()
        try:
            asked = _read_object(body)
            utterance = require_utterance(asked.get("utterance"))
            beam = require_beam(asked.get("beam", USUAL_BEAM))
            service = self._find(world, asked.get("run"))
            (answer,) = service.parse([utterance], beam)
        except NotServed as error:
            self._count(world if error.status != 404 else "", error.status)
            raise
        except ValueError as error:
            self._count("", 400)
            raise NotServed(400, str(error)) from error
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
        except ValueError as error:
            raise NotServed(400, f"run and beam are whole numbers. {error}") from error
        service = self._find(world, run)
        self._count(world, 200)
        headers = [("Content-Type", JSON_LINES)]
        start_response(f"200 {REASONS[200]}", headers)
        return self._answer_lines(service, body.splitlines(), beam)

    def _answer_lines(self, service: Service, lines: list[bytes], beam: int) -> Iterator[bytes]:
        numbered = [(number, line) for number, line in enumerate(lines, 1) if line.strip()]
        together = service.parser.lines_together
        for at in range(0, len(numbered), together):
            # One thread does both. A second one that parsed the next lines meanwhile would have to wait for
            # the interpreter's lock after each operation of the network, for longer than writing takes.
            answers = _ask_some(service, numbered[at : at + together], beam)
            yield _write_some(service, answers)
            self._shelf.metrics.utterances.labels(world=service.world).inc(len(answers))

    def _find(self, world: str, run: object) -> Service:
        if run is not None and (not isinstance(run, int) or isinstance(run, bool)):
            raise NotServed(400, "run has to be the number of a run.")
        return self._shelf.find(world, run, LOADING_PATIENCE)

    def _count(self, world: str, status: int) -> None:
        self._shelf.metrics.requests.labels(world=world, status=str(status)).inc()


def _ask_some(
    service: Service, lines: list[tuple[int, bytes]], beam: int
) -> dict[int, Asked | str]:
    """Return what the parser answers to each line, by its number; what is wrong with one as JSON."""
    answers: dict[int, Asked | str] = dict.fromkeys((number for number, _ in lines), "")
    utterances: dict[int, str] = {}
    for number, line in lines:
        try:
            utterances[number] = require_utterance(_read_object(line).get("utterance"))
        except ValueError as error:
            answers[number] = _refuse_line(number, str(error))
    try:
        asked = service.ask(list(utterances.values()), beam) if utterances else []
        answers |= zip(utterances, asked, strict=True)
    except NotServed as error:
        answers |= {number: _refuse_line(number, str(error)) for number in utterances}
    except Exception:
        logger.exception("A batch for %s", service.world)
        answers |= {number: _refuse_line(number, FAILED) for number in utterances}
    return answers


def _write_some(service: Service, answers: dict[int, Asked | str]) -> bytes:
    """Return a line of JSON for each line; what is wrong with one is said in its place."""
    return _encode("".join(f"{_write(service, *answer)}\n" for answer in answers.items()))


def _write(service: Service, number: int, answer: Asked | str) -> str:
    if isinstance(answer, str):
        return answer
    try:
        return service.write(answer)
    except Exception:
        logger.exception("Line %s of a batch for %s", number, service.world)
        return _refuse_line(number, FAILED)


def _refuse_line(number: int, sentence: str) -> str:
    return as_json({"line": number, "detail": f"Line {number}: {sentence}"})


def _read_object(body: bytes) -> dict[str, Any]:
    """Return the JSON object that ``body`` writes. Raises ValueError, a sentence."""
    try:
        value = json.loads(body)
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise ValueError('This is not a JSON object such as {"utterance": "bring me the apple"}.')
    return value


def _encode(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def _send_json(start_response: StartResponse, status: int, value: object) -> list[bytes]:
    return _send(start_response, status, JSON, _encode(as_json(value)))


def _send(start_response: StartResponse, status: int, kind: str, body: bytes) -> list[bytes]:
    headers = [("Content-Type", kind), ("Content-Length", str(len(body)))]
    start_response(f"{status} {REASONS[status]}", headers)
    return [body]
