"""What leaves this machine, and for whom: redirects, proxies, keys, certificates and names."""

from __future__ import annotations

import json
import logging
import socket
import ssl
import subprocess
from dataclasses import replace
from shutil import which

import pytest

from annotations.language.texts.errors import Refusal
from parser_service.parsers.model_server import exchange
from parser_service.parsers.model_server.asker import Asker
from parser_service.parsers.server_address import ModelServer
from tests.parser_service.llm_server import KEY, QUICK, fails, says, sends, tiny_server
from tests.parser_service.parsers.model_server.questions import ask, question


@pytest.mark.parametrize("status", [301, 302, 307, 308])
def test_nothing_is_sent_where_a_redirect_leads(place, tiny, status):
    with tiny_server() as other:
        to = other.url.replace("127.0.0.1", "localhost")
        tiny.always = sends(b"", status, Location=f"{to}/chat/completions?secret=x")
        with pytest.raises(Refusal, match="localhost") as caught:
            ask(place, question())
        assert caught.value.code == "language_model_refused"
        assert other.asked == other.headers == []
    assert "secret" not in str(caught.value)
    tiny.always = sends(b"", status, Location="/v1/chat/completions/")
    with pytest.raises(Refusal, match="GPSR_LLM_URL") as refused:
        ask(place, question())
    assert refused.value.code == "language_model_refused"
    assert "localhost" not in refused.value.message


def test_no_proxy_of_the_environment_is_used(place, tiny, monkeypatch):
    for name in ("http_proxy", "HTTP_PROXY", "all_proxy", "ALL_PROXY"):
        monkeypatch.setenv(name, "http://127.0.0.1:9/")
    monkeypatch.delenv("no_proxy", raising=False)
    assert ask(place, question()) == ["a"]


def test_the_key_is_sent_and_stands_nowhere_else(place, tiny, caplog, tmp_path):
    caplog.set_level(logging.DEBUG)
    told = []
    for body in (
        sends(json.dumps({"error": {"message": f"Wrong key Bearer {KEY}"}}).encode(), 401),
        fails(500, KEY),
        sends(KEY.encode()),
        sends(b"", 307, Location=f"http://{KEY}/"),
    ):
        tiny.always = body
        with pytest.raises(Refusal) as caught:
            ask(place, question())
        assert caught.value.code == "language_model_refused"
        told.append(f"{caught.value!r} {caught.value.__cause__!r}")
    tiny.always, tiny.reports = says(f"your key is {KEY}"), KEY
    answers = Asker(place, 1).ask([question()], lambda: None)
    assert all(each["Authorization"] == f"Bearer {KEY}" for each in tiny.headers)
    files = [path.read_text() for path in (tmp_path / "llm").rglob("*.json")]
    assert len(files) == 1
    told += [*files, caplog.text, repr(place), str(place), repr(answers), repr(Asker(place, 1))]
    assert [text for text in told if KEY in text] == []


@pytest.fixture
def certified(tiny, tmp_path):
    """The server speaks HTTPS with a certificate that nobody vouches for; returns the file with it."""
    openssl = which("openssl")
    if openssl is None:
        pytest.skip("needs openssl, which makes a certificate")
    files = {name: tmp_path / f"{name}.pem" for name in ("keyout", "out")}
    named = [text for name, path in files.items() for text in (f"-{name}", str(path))]
    made_for = ["-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"]
    kind = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2"]
    run = [openssl, "req", "-x509", *kind, *made_for, *named]
    subprocess.run(run, check=True, capture_output=True)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(files["out"], files["keyout"])
    tiny.socket = context.wrap_socket(tiny.socket, server_side=True)
    return files["out"]


def test_a_certificate_is_looked_at_and_its_name_too(place, tiny, certified, monkeypatch):
    port = tiny.server_address[1]
    by_name = replace(place, url=f"https://localhost:{port}/v1")
    with pytest.raises(Refusal, match=r"certificate .*localhost:\d+") as refused:
        ask(by_name, question())
    assert refused.value.code == "language_model_refused"
    monkeypatch.setenv("SSL_CERT_FILE", str(certified))
    assert ask(by_name, question()) == ["a"]
    with pytest.raises(Refusal, match=r"certificate .*127.0.0.1:\d+") as refused:
        ask(replace(place, url=f"https://127.0.0.1:{port}/v1"), question("another"))
    assert refused.value.code == "language_model_refused"
    assert len(tiny.asked) == 1


def test_a_name_that_leads_elsewhere_is_refused_after_it_is_looked_up(monkeypatch):
    def look_up(host, port, **_):
        return [
            (socket.AF_INET, socket.SOCK_STREAM, 6, "", ("127.0.0.1", port)),
            (socket.AF_INET, socket.SOCK_STREAM, 6, "", ("192.0.2.7", port)),
        ]

    monkeypatch.setattr(exchange.socket, "getaddrinfo", look_up)
    place = ModelServer("http://models.example.org/v1", patience=QUICK)
    with pytest.raises(Refusal, match="GPSR_LLM_REMOTE=1") as refused:
        ask(place, question())
    assert refused.value.code == "language_model_refused"
    open_line = replace(place, key=KEY, may_be_remote=True)
    with pytest.raises(Refusal, match=r"GPSR_LLM_KEY .*models\.example\.org") as refused:
        ask(open_line, question())
    assert refused.value.code == "language_model_refused"
