"""The address of a language model's server: what may be asked, and what is said where it may not."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from ipaddress import ip_address

import pytest

from parser_service.parsers.pretrained_files import find_gaps
from parser_service.parsers.registry import make_config
from parser_service.parsers.server_address import ModelServer, Patience, is_this_machine, problem_of
from tests.parser_service.llm_server import KEY, installed

HERE = "http://127.0.0.1:8080/v1"


@pytest.mark.parametrize(
    "url",
    [
        HERE,
        "http://localhost:11434/v1/",
        "http://[::1]:8000",
        "http://127.9.9.9/v1",
        "https://models.example.org/v1",
    ],
)
def test_an_address_of_this_machine_or_a_name_is_accepted(url):
    assert problem_of(ModelServer(url, KEY)) == ""


@pytest.mark.parametrize(
    ("server", "named"),
    [
        (ModelServer(), "GPSR_LLM_URL .*OpenAI"),
        (ModelServer("127.0.0.1:8080"), "http://.*https://"),
        (ModelServer("ftp://127.0.0.1/v1"), "http://.*https://"),
        (ModelServer("file:///etc/passwd"), "http://.*https://"),
        (ModelServer("http://"), "http://.*https://"),
        (ModelServer("http://127.0.0.1:70000/v1"), "http://.*https://"),
        (ModelServer("http://127.0.0.1:0/v1"), "http://.*https://"),
        (ModelServer("http://[::1/v1"), "http://.*https://"),
        (ModelServer("http://127.0.0.1/v1\r\nX: y"), "http://.*https://"),
        (ModelServer(f"http://me:{KEY}@127.0.0.1/v1"), "GPSR_LLM_KEY"),
        (ModelServer(f"http://{KEY}@127.0.0.1/v1"), "GPSR_LLM_KEY"),
        (ModelServer(f"{HERE}?key={KEY}"), "^GPSR_LLM_URL "),
        (ModelServer(HERE, f"{KEY}\nX-Other: 1"), "^GPSR_LLM_KEY "),
        (ModelServer(HERE, "schlüssel"), "^GPSR_LLM_KEY "),
        (ModelServer(HERE, patience=Patience(answer=0)), "^GPSR_LLM_SECONDS .* 0"),
        (ModelServer(HERE, patience=Patience(answer=float("nan"))), "^GPSR_LLM_SECONDS .* 0"),
        (ModelServer("http://192.0.2.7/v1"), "GPSR_LLM_REMOTE"),
        (ModelServer("http://0.0.0.0:8080/v1"), "GPSR_LLM_REMOTE"),
        (ModelServer("http://[2001:db8::1]/v1"), "GPSR_LLM_REMOTE"),
        (ModelServer("http://192.0.2.7/v1", KEY, True), r"GPSR_LLM_KEY .* 192\.0\.2\.7"),
    ],
)
def test_any_other_is_refused_without_repeating_what_may_be_secret(server, named):
    problem = problem_of(server)
    assert re.search(named, problem) and problem.endswith(".")
    assert KEY not in problem


@pytest.mark.parametrize("url", ["http://192.0.2.7:8000/v1", "https://192.0.2.7/v1"])
def test_another_machine_may_be_asked_where_that_is_allowed(url):
    key = KEY if url.startswith("https") else ""
    assert problem_of(ModelServer(url, key, may_be_remote=True)) == ""


def test_an_address_in_the_clothes_of_another_is_seen_through():
    assert is_this_machine(ip_address("::ffff:127.0.0.1"))
    assert not is_this_machine(ip_address("::ffff:192.0.2.7"))


@pytest.mark.parametrize(
    ("url", "name", "path"),
    [
        ("http://127.0.0.1:8080", "127.0.0.1:8080", "/v1"),
        ("http://localhost/", "localhost:80", "/v1"),
        ("https://example.org/proxy/v1/", "example.org:443", "/proxy/v1"),
    ],
)
def test_an_address_may_leave_out_what_is_usual(url, name, path):
    server = ModelServer(url)
    assert (server.name, server.path) == (name, path)


def test_the_row_says_that_there_is_no_server_and_no_other_row_does():
    with installed(ModelServer()):
        [gap] = find_gaps(make_config("llm"))
        assert gap.name == "GPSR_LLM_URL" and "docs/guides/llm.md" in gap.sentence
        assert find_gaps(make_config("knn")) == []
    with installed(ModelServer(HERE)):
        assert find_gaps(make_config("llm")) == []


def test_the_environment_is_where_it_all_comes_from():
    code = (
        "import django; django.setup()\n"
        "from parser_service.parsers.server_address import server\n"
        "each = server()\n"
        "print(each.url, each.key, each.may_be_remote, each.patience.answer, each.answers.name)"
    )
    environment = {
        **os.environ,
        "DJANGO_SETTINGS_MODULE": "gpsr_site.settings",
        "GPSR_LLM_URL": f" {HERE} ",
        "GPSR_LLM_KEY": f"{KEY}\n",
        "GPSR_LLM_REMOTE": "1",
        "GPSR_LLM_SECONDS": "7.5",
    }
    told = subprocess.check_output([sys.executable, "-c", code], env=environment, text=True)
    assert told.split() == [HERE, KEY, "True", "7.5", "llm"]
