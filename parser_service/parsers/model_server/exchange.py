"""One HTTP request to the server and its reply: no proxy, no redirect, a bounded size.

``http.client`` is what ``urllib`` is made of. It is used itself because ``urllib`` obeys the proxies of the
environment, follows redirects with the key, and connects to whatever a name stands for by then.
"""

from __future__ import annotations

import socket
import ssl
import time
from collections.abc import Mapping
from contextlib import closing, suppress
from dataclasses import dataclass
from http.client import HTTPConnection, HTTPException, HTTPResponse
from ipaddress import ip_address
from urllib.parse import urlsplit

from annotations.language.texts import Refusal
from parser_service.parsers.server_address import ModelServer, problem_of, refusal_of

MOST_BYTES = 1024 * 1024  # of a reply; an answer has a few thousand
PIECE = 64 * 1024


class ServerRefusal(Refusal):
    """Asking the language model's server again would change nothing. It says what to do."""

    code = "language_model_refused"


class NoAnswer(ServerRefusal):
    """This question cannot be answered; others may be."""


class NoReply(Exception):
    """Nothing came that can be read; it may next time. A part of a sentence, and the seconds ``after`` which
    the server wants to be asked again, None where it does not say."""

    def __init__(self, words: str, after: float | None = None) -> None:
        super().__init__(words)
        self.after = after


class Abandoned(Exception):
    """Nobody waits for the reply any more."""


@dataclass(frozen=True, slots=True)
class Reply:
    """What a server answered. Names of ``headers`` are in lower case."""

    status: int
    headers: Mapping[str, str]
    body: bytes


class Exchange:
    """A request and its reply, which ``send`` waits for. Another thread may end that by ``abandon`` or,
    once it takes too long, by ``look_at_the_clock``."""

    def __init__(self, server: ModelServer, seconds: float) -> None:
        self._server = server
        self._seconds = seconds
        self._until = time.monotonic() + seconds
        self._socket: socket.socket | None = None
        self._is_abandoned = False
        self._is_late = False

    def send(self, method: str, path: str, body: bytes | None = None) -> Reply:
        """Return the reply, whatever its status. Raises ServerRefusal, NoReply and Abandoned."""
        headers = {"Accept": "application/json", "User-Agent": "gpsr-workbench"}
        if body is not None:
            headers["Content-Type"] = "application/json"
        if self._server.key:
            headers["Authorization"] = f"Bearer {self._server.key}"
        try:
            with closing(self._connect()) as connection:
                connection.request(method, self._server.path + path, body, headers)
                return self._read(connection.getresponse())
        except (OSError, HTTPException) as error:
            if self._is_abandoned:
                raise Abandoned from None
            if self._is_late or isinstance(error, TimeoutError):
                raise NoReply(f"it took longer than {self._seconds:g} s") from None
            raise NoReply(_in_words(error)) from None

    def abandon(self) -> None:
        """End the exchange: nobody waits for it."""
        self._is_abandoned = True
        self._hang_up()

    def look_at_the_clock(self) -> None:
        """End the exchange if it takes too long."""
        if time.monotonic() > self._until:
            self._is_late = True
            self._hang_up()

    def _hang_up(self) -> None:
        if self._socket is not None:
            with suppress(OSError):  # not connected any more
                self._socket.shutdown(socket.SHUT_RDWR)

    def _connect(self) -> HTTPConnection:
        """Connect to an address that was looked at, so that the name cannot stand for another by then."""
        server = self._server
        if problem := problem_of(server):
            raise ServerRefusal(problem)
        self._socket = _reach(server)
        self._socket.settimeout(self._seconds)
        if server.parts.scheme == "https":
            self._socket = _encrypt(self._socket, server)
        if self._is_abandoned or self._is_late:
            self._socket.close()
            raise TimeoutError
        connection = HTTPConnection(server.host, server.port)
        connection.sock = self._socket
        return connection

    def _read(self, response: HTTPResponse) -> Reply:
        if 300 <= response.status < 400:
            raise ServerRefusal(_redirected(self._server, response.getheader("Location", "")))
        body = b""
        while piece := response.read(PIECE):
            body += piece
            if len(body) > MOST_BYTES:
                raise NoAnswer(
                    f"The server at {self._server.name} answers with more than {MOST_BYTES:,} bytes, which is "
                    "no answer of a language model. Look at the address in GPSR_LLM_URL."
                )
        if self._is_abandoned or self._is_late:  # the end may be that of the line
            raise TimeoutError
        if response.length:
            raise NoReply("its answer was cut off")
        headers = {name.lower(): value for name, value in response.getheaders()}
        return Reply(response.status, headers, body)


def _reach(server: ModelServer) -> socket.socket:
    """Connect to the first address of the server that answers, if all of them may be asked."""
    try:
        found = socket.getaddrinfo(server.host, server.port, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError) as error:
        raise NoReply(f"the name {server.host} is not known ({_in_words(error)})") from None
    hosts = [ip_address(str(address[0]).partition("%")[0]) for *_, address in found]
    if refusal := refusal_of(server, hosts):
        raise ServerRefusal(refusal)
    faults = []
    for family, kind, protocol, _, address in found:
        line = socket.socket(family, kind, protocol)
        line.settimeout(server.patience.connecting)
        try:
            line.connect(address)
        except OSError as error:
            line.close()
            faults.append(_in_words(error))
        else:
            return line
    raise NoReply("; ".join(dict.fromkeys(faults)) or "it has no address")


def _encrypt(line: socket.socket, server: ModelServer) -> socket.socket:
    try:
        return ssl.create_default_context().wrap_socket(line, server_hostname=server.host)
    except ssl.SSLCertVerificationError as error:
        line.close()
        raise ServerRefusal(
            f"The certificate of {server.name} is not to be trusted: {error.verify_message}. Set "
            "GPSR_LLM_URL to the name that its certificate has, or have the system trust it."
        ) from None
    except OSError:
        line.close()
        raise


def _redirected(server: ModelServer, location: str) -> str:
    try:
        target = urlsplit(location).hostname or server.host
    except ValueError:
        target = server.host
    if server.key and server.key.lower() in target:  # names of hosts are in lower case
        target = "…"
    where = "elsewhere on its own host" if target == server.host else f"to the host {target[:100]}"
    return (
        f"The server at {server.name} sends the question {where}. Nothing is sent there. Set GPSR_LLM_URL "
        "to the address that answers itself."
    )


def _in_words(error: Exception) -> str:
    """Say in a few words what happened on the line. Messages of ``http.client`` may repeat what was sent."""
    if isinstance(error, HTTPException):
        return "its answer was cut off or is not HTTP"
    if isinstance(error, TimeoutError):
        return "it took too long"
    words = getattr(error, "strerror", None) or type(error).__name__
    return str(words)[:200].lower()
