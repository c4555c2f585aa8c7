"""Where the language model's server is, and what is wrong with that address.

Nothing is asked here and no name is looked up: pages look here, too. Address and key come from the
environment of the installation, never from a request.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from ipaddress import IPv4Address, IPv6Address, ip_address
from pathlib import Path
from urllib.parse import SplitResult, urlsplit

ADDRESS = "GPSR_LLM_URL"
EXAMPLE = "http://127.0.0.1:8080/v1"
USUAL_PATH = "/v1"  # where an address has none
PORTS = {"http": 80, "https": 443}

NOT_SET = (
    f"There is no language model to ask: {ADDRESS} is not set. Start a server that speaks OpenAI's "
    f"protocol (llama.cpp, Ollama, vLLM), set {ADDRESS} to its address, such as {EXAMPLE}, and start the "
    "site and its workers again (docs/guides/llm.md)."
)


@dataclass(frozen=True, slots=True)
class Patience:
    """How long a server is waited for, in seconds, and how often it is asked.

    ``longest_pause`` is the longest that a server may ask to be left alone (Retry-After).
    """

    connecting: float = 5.0
    answer: float = 120.0
    tries: int = 4
    first_pause: float = 1.0
    longest_pause: float = 120.0


@dataclass(frozen=True, slots=True)
class ModelServer:
    """A server of the protocol. ``answers`` is the folder that keeps what it answered, None for none."""

    url: str = ""
    key: str = field(default="", repr=False)
    may_be_remote: bool = False
    patience: Patience = Patience()
    answers: Path | None = None

    @property
    def parts(self) -> SplitResult:
        return urlsplit(self.url)

    @property
    def host(self) -> str:
        return self.parts.hostname or ""

    @property
    def port(self) -> int:
        return self.parts.port or PORTS[self.parts.scheme]

    @property
    def path(self) -> str:
        """The path of the protocol's version 1, without a slash at its end."""
        return self.parts.path.rstrip("/") or USUAL_PATH

    @property
    def name(self) -> str:
        """What sentences call the server: its host and port."""
        return f"{self.host}:{self.port}"


_server = ModelServer()


def use_server(server: ModelServer) -> None:
    """Set the server of this installation."""
    global _server
    _server = server


def server() -> ModelServer:
    """Return the server of this installation."""
    return _server


def problem_of(server: ModelServer) -> str:
    """Return why ``server`` cannot be asked, and what to do about it; empty where it can, as far as its
    address tells. The address itself is not repeated: it may hold a secret."""
    if not server.url:
        return NOT_SET
    if fault := _fault_of_address(server):
        return fault
    if not all("!" <= sign <= "~" for sign in server.key):
        return (
            "GPSR_LLM_KEY holds a space or another sign that no key has. Set it to the key alone."
        )
    if not server.patience.answer > 0:
        return "GPSR_LLM_SECONDS has to be more than 0: it is how long one answer may take."
    address = literal_address(server.host)
    return "" if address is None else refusal_of(server, [address])


def refusal_of(server: ModelServer, addresses: list[IPv4Address | IPv6Address]) -> str:
    """Return why ``server``, which is at ``addresses``, may not be asked; empty where it may."""
    if all(map(is_this_machine, addresses)):
        return ""
    if not server.may_be_remote:
        return (
            f"{ADDRESS} names {server.host}, which is another machine: commands and forms would leave "
            "this one. Set GPSR_LLM_REMOTE=1 where they may (docs/guides/llm.md)."
        )
    if server.key and server.parts.scheme != "https":
        return (
            f"{ADDRESS} begins with http://, so GPSR_LLM_KEY would travel to {server.host} for everybody "
            "to read. Use https://, or a tunnel that ends on this machine."
        )
    return ""


def is_this_machine(address: IPv4Address | IPv6Address) -> bool:
    """Return whether ``address`` leads back to this machine."""
    mapped = getattr(address, "ipv4_mapped", None)
    return (mapped or address).is_loopback


def literal_address(host: str) -> IPv4Address | IPv6Address | None:
    """Return the address that ``host`` writes; None where it is a name."""
    try:
        return ip_address(host.partition("%")[0])
    except ValueError:
        return None


def _fault_of_address(server: ModelServer) -> str:
    try:
        parts = server.parts
        is_address = parts.scheme in PORTS and bool(parts.hostname) and parts.port != 0
    except ValueError:  # brackets or a port that are none
        is_address = False
    if not is_address or not server.url.isprintable() or " " in server.url:
        return f"{ADDRESS} is no address that begins with http:// or https://, such as {EXAMPLE}."
    if parts.username is not None or parts.password is not None:
        return f"{ADDRESS} holds a user or a password. Put the key into GPSR_LLM_KEY instead."
    if parts.query or parts.fragment:
        return (
            f"{ADDRESS} goes on after its path (? or #). It ends with the path, such as {EXAMPLE}."
        )
    return ""
