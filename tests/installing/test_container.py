"""Containerfile and compose.yaml name what is there: files, commands, variables and one another."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import threading
import tomllib
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from urllib.parse import urlsplit

import pytest
import yaml
from django.core.management import get_commands, load_command_class

from annotations.models.background import Queue

ROOT = Path(__file__).resolve().parents[2]
LINES = (ROOT / "Containerfile").read_text(encoding="utf-8").splitlines()
STEPS = [line.split(maxsplit=1) for line in LINES if line and not line.startswith("#")]
KNOWN = {
    *("FROM", "ARG", "WORKDIR", "COPY", "RUN", "ENV", "USER", "VOLUME", "EXPOSE"),
    *("HEALTHCHECK", "ENTRYPOINT", "CMD"),
}
DOCUMENTED = (ROOT / "docs" / "reference" / "variables.md").read_text(encoding="utf-8")
VARIABLES = set(re.findall(r"^\| `([A-Z_]+)` \|", DOCUMENTED, re.MULTILINE))
OF_OTHERS = {"PYTHONUNBUFFERED", "PIP_NO_CACHE_DIR", "PIP_EXTRA_INDEX_URL"}


def arguments(name: str) -> list[str]:
    return [rest for step, rest in STEPS if step == name]


def test_every_line_is_an_instruction():
    assert {step for step, _ in STEPS} <= KNOWN
    assert STEPS[0][0] == "FROM"


@pytest.mark.parametrize("copied", [each for each in arguments("COPY") if "--from" not in each])
def test_what_is_copied_is_there(copied):
    for source in copied.split()[:-1]:
        assert (ROOT / source).exists()


def test_it_calls_a_command_as_somebody_who_is_not_root():
    (entry,), (command,) = arguments("ENTRYPOINT"), arguments("CMD")
    program, manage = json.loads(entry)
    assert (program, manage) == ("gpsr-workbench", "manage")
    assert program in tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["scripts"]
    assert json.loads(command)[0] in get_commands()
    assert arguments("USER") == ["gpsr"]


def test_its_variables_are_documented():
    names = {name for each in arguments("ENV") for name in re.findall(r"([A-Z_]+)=", each)}
    assert names - OF_OTHERS <= VARIABLES


@pytest.mark.parametrize("status, code", [(200, 0), (400, 0), (503, 1)])
def test_the_check_of_health_asks_what_serves(status, code):
    (words,) = arguments("HEALTHCHECK")
    _, python, option, program = json.loads(
        words[words.index("CMD") :].replace("CMD [", '["CMD", ')
    )

    class Answer(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(status if self.path == "/healthz" else 500)
            self.end_headers()

    with HTTPServer(("127.0.0.1", 0), Answer) as server:
        threading.Thread(target=server.handle_request, daemon=True).start()
        program = program.replace("8000", str(server.server_port))
        assert (python, option) == ("python", "-c")
        done = subprocess.run([sys.executable, option, program], check=False)
    assert done.returncode == code


def test_the_wheel_is_made_of_all_sources():
    packages = {path.parent.name for path in ROOT.glob("*/apps.py")}
    assert {f"{name} ./{name}" for name in packages} <= set(arguments("COPY"))


COMPOSE = yaml.safe_load((ROOT / "compose.yaml").read_text(encoding="utf-8"))
SERVICES = COMPOSE["services"]
OURS = {name: each for name, each in SERVICES.items() if each["image"] == "gpsr-workbench"}


def test_the_services_are_commands_of_this_project():
    assert {each["command"][0] for each in OURS.values()} == {
        *("migrate", "collectstatic", "serve", "parse_server", "work"),
    }
    for each in OURS.values():
        name, *options = each["command"]
        load_command_class(get_commands()[name], name).create_parser("manage.py", name).parse_args(
            options
        )


@pytest.mark.parametrize("name", OURS)
def test_what_lasts_is_started_again(name):
    lasts = OURS[name]["command"][0] not in ("migrate", "collectstatic")
    assert OURS[name]["restart"] == ("unless-stopped" if lasts else "no")


def test_each_part_says_how_it_is_checked():
    serving = {"serve": None, "parse_server": "http://127.0.0.1:8100/healthz"}
    for each in OURS.values():
        check = each.get("healthcheck")
        address = serving.get(each["command"][0], "unchecked")
        if address is None:  # by the image
            assert check is None
        elif address == "unchecked":
            assert check == {"disable": True}
        else:
            assert address in check["test"][-1]
            assert each["environment"]["PARSER_PORT"] == "8100"


def test_the_services_know_one_another():
    for each in OURS.values():
        variables = each["environment"]
        assert set(variables) <= VARIABLES
        for name in ("DATABASE_URL", "CELERY_BROKER_URL", "PARSER_URL"):
            host = urlsplit(variables[name]).hostname
            assert host in SERVICES, name
        assert urlsplit(variables["PARSER_URL"]).port == int(variables["PARSER_PORT"])
        assert set(each.get("depends_on", ())) <= set(SERVICES)
    volumes = (
        volume.split(":")[0] for each in SERVICES.values() for volume in each.get("volumes", ())
    )
    assert set(volumes) == set(COMPOSE["volumes"])


def test_two_queues_have_workers_and_everything_waits_for_the_tables():
    queues = {
        queue
        for each in OURS.values()
        if each["command"][0] == "work"
        for queue in each["command"][2:]
    }
    assert queues == set(Queue.values)
    for name in OURS.keys() - {"migrate", "web"}:
        assert OURS[name]["depends_on"]["migrate"]["condition"] == "service_completed_successfully"
