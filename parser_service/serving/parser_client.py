"""How pages and REST ask the parse server. Loads no parser and no torch."""

from __future__ import annotations

import json
import math
import select
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from http import HTTPStatus
from http.client import HTTPConnection, HTTPException, HTTPResponse, HTTPSConnection
from typing import Any
from urllib.parse import urlencode, urlsplit

from django.conf import settings

from annotations.language.texts import Refusal

CONNECT_SECONDS = 0.8
# A server that has ended closes its connections. One that answers nothing is looked at again and again: it may be
# busy, with requests or with a parser that it loads, and is away once it has been silent for so long.
LOOK_AFTER = 0.6
ALIVE_SECONDS = 0.5
SILENT_SECONDS = 8.0
PATIENCE = 30.0
CONTINUES = b"HTTP/1.1 100"
AWAY = "The parse server is away. Nothing is lost; it answers again when it is back."
BUSY = f"The parse server is busy: it has not answered within {PATIENCE:g} s. Ask again."


class ParserAway(Refusal):
    """Nobody answers."""

    code = "parser_away"
    status = HTTPStatus.SERVICE_UNAVAILABLE
    wait = 2

    def __init__(self, message: str = AWAY) -> None:
        super().__init__(message)


class ParserRefused(Refusal):
    """The parse server cannot answer this request, as its ``status`` and its sentence say."""

    code = "not_parsed"

    def __init__(self, status: int, sentence: str, code: str = "") -> None:
        super().__init__(sentence, code, status)


@dataclass(frozen=True)
class ParserClient:
    """Asks the parse server at ``url``. Everything raises ``ParserAway`` where it is away: at once where nobody
    listens or it ends, within ``SILENT_SECONDS`` where it has stopped without an end."""

    url: str
    secret: str = field(repr=False)

    def parse(
        self,
        world: str,
        utterance: str,
        beam: int = 5,
        run: int | None = None,
        parser: str = "",
        alternatives: Sequence[Mapping[str, Any]] = (),
    ) -> dict[str, Any]:
        """Return the answer of ``world`` (docs/reference/parse-server.md), or that of ``run`` or ``parser`` alone.

        Where a recogniser gives ``alternatives``, each with ``utterance`` and ``score``, the best that is understood is
        answered. Raises ParserRefused where there is no such world or run, or nothing answers there.
        """
        body: dict[str, Any] = {"utterance": utterance, "beam": beam, "run": run, "parser": parser}
        if alternatives:
            body["alternatives"] = list(alternatives)
        with closing(self._connect()) as connection:
            path = f"/api/v1/worlds/{world}/parse/"
            response = self._ask(connection, "POST", path, json.dumps(body).encode())
            answer: dict[str, Any] = _read_json(response)
            return answer

    def parse_lines(
        self,
        world: str,
        lines: bytes,
        beam: int = 5,
        run: int | None = None,
        parser: str = "",
        most_seconds: float = math.inf,
    ) -> Iterator[bytes]:
        """Ask about JSON lines; return an iterator over the answers, line by line, as they come.

        Raises as ``parse`` does, before it returns. The iterator raises ParserAway where it breaks off; where
        the server dies it may also just end, with fewer answers than there are lines.
        """
        named = {"run": run, "parser": parser}
        query = urlencode({"beam": beam} | {name: value for name, value in named.items() if value})
        connection = self._connect()
        try:
            path = f"/api/v1/worlds/{world}/parse/?{query}"
            response = self._ask(connection, "POST", path, lines, "application/jsonl")
        except BaseException:
            connection.close()
            raise
        return _read_lines(connection, response, most_seconds)

    def parsers(self) -> list[dict[str, Any]]:
        """Return which run answers in each world, and what went wrong with a promoted one."""
        with closing(self._connect()) as connection:
            listed: list[dict[str, Any]] = _read_json(
                self._ask(connection, "GET", "/api/v1/parsers/")
            )
            return listed

    def is_alive(self) -> bool:
        """Return whether the server answers at all, within ``ALIVE_SECONDS``.

        It is asked to go on, as before a large body (RFC 9110, 10.1.1): its listening thread says so, whatever the
        threads that carry requests out are busy with.
        """
        try:
            with closing(self._connect(ALIVE_SECONDS)) as connection:
                connection.putrequest("POST", "/healthz")
                connection.putheader("Content-Length", "1")
                connection.putheader("Expect", "100-continue")
                connection.endheaders()
                return connection.sock.recv(len(CONTINUES)).startswith(CONTINUES)
        except (ParserAway, OSError, HTTPException):
            return False

    def _connect(self, seconds: float = CONNECT_SECONDS) -> HTTPConnection:
        address = urlsplit(self.url)
        kind = HTTPSConnection if address.scheme == "https" else HTTPConnection
        connection = kind(address.hostname or "", address.port, timeout=seconds)
        try:
            connection.connect()
        except OSError as error:
            raise ParserAway from error
        return connection

    def _ask(
        self,
        connection: HTTPConnection,
        method: str,
        path: str,
        body: bytes | None = None,
        content_type: str = "application/json",
    ) -> HTTPResponse:
        """Send a request and wait for the answer as long as the server lives. Raises as ``parse``."""
        headers: Mapping[str, str] = {
            "Authorization": f"Bearer {self.secret}",
            "Content-Type": content_type,
        }
        try:
            connection.request(method, path, body, headers)
            self._wait_for_answer(connection)
            connection.sock.settimeout(PATIENCE)
            response = connection.getresponse()
        except (OSError, HTTPException) as error:
            raise ParserAway from error
        if response.status == 401:
            sentence = "The parse server has another secret than this site (PARSER_SECRET)."
            raise ParserAway(sentence)
        if response.status != 200:
            try:
                said = json.loads(response.read())
                detail, code = str(said["detail"]), str(said["code"])
            except (OSError, HTTPException, ValueError, KeyError, TypeError, RecursionError):
                detail, code = f"The parse server answered with status {response.status}.", ""
            raise ParserRefused(response.status, detail, code)
        return response

    def _wait_for_answer(self, connection: HTTPConnection) -> None:
        """Wait until something can be read. Raises ParserAway where the server has stopped answering."""
        began = heard = time.monotonic()
        answer = select.poll()  # select() takes no file descriptor above 1023
        answer.register(connection.sock, select.POLLIN)
        while not answer.poll(LOOK_AFTER * 1000):
            if self.is_alive():
                heard = time.monotonic()
            if time.monotonic() - heard > SILENT_SECONDS:
                raise ParserAway
            if time.monotonic() - began > PATIENCE:
                raise ParserAway(BUSY)


def client() -> ParserClient:
    """Return the client of this installation's parse server."""
    return ParserClient(settings.PARSER_URL, settings.PARSER_SECRET)


def _read_json(response: HTTPResponse) -> Any:
    try:
        return json.loads(response.read())
    except (OSError, HTTPException, ValueError, RecursionError) as error:
        raise ParserAway from error


def _read_lines(
    connection: HTTPConnection, response: HTTPResponse, most_seconds: float
) -> Iterator[bytes]:
    """Yield the answers, line by line, for ``most_seconds``. Raises ParserAway where the server ends."""
    until = time.monotonic() + most_seconds
    with closing(connection):
        try:
            while line := response.readline():
                if not line.endswith(b"\n"):
                    break
                yield line
                if time.monotonic() > until:
                    raise ParserAway(f"The server stopped after {most_seconds:g} seconds.")
        except (OSError, HTTPException) as error:
            raise ParserAway from error
