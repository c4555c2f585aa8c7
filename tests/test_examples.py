"""The examples that a newcomer meets run as they are, on the starter world as ``make run`` leaves it.

A block of README, guides, REST and the client runs, unless the line above it is one of ``*Needs …*`` (a server, a
folder, an hour) and ``*Output …*``, for people to read. What needs something is checked by the parsers of its commands.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import shlex
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest
from django.core.management import call_command, get_commands, load_command_class

from annotations.exchange.starter_world import STARTER_WORLD, load_starter_world
from annotations.models import ApiToken, Entity, World
from parser_service.models import TrainingRun
from tests.clients.conftest import CLIENT
from tests.parser_service.live_server import parse_server  # noqa: F401

ROOT = Path(__file__).resolve().parent.parent
PAGES = [
    ROOT / "README.md",
    *sorted((ROOT / "docs" / "guides").glob("*.md")),
    CLIENT / "README.md",
    ROOT / "docs" / "reference" / "rest.md",  # last: it changes the world
]
FENCE = re.compile(r"^(?:\*((?:Needs|Output)\b[^*]+)\*\n\n?)?```(\w*)\n(.*?)^```", re.M | re.S)
SHELLS = ("sh", "bash")
FILES = ("ini", "nginx", "yaml")  # of other programs
LANGUAGES = {*SHELLS, *FILES, "python", "json", "text"}
MANAGE = ".venv/bin/python manage.py "
SITE = "http://localhost:8000"
ANSWERS = ("the salad bowl", "yes")


@dataclass(frozen=True)
class Example:
    """A block of a page. ``mark`` says what it needs, or that it is an output; empty where it runs."""

    page: Path
    line: int
    language: str
    text: str
    mark: str

    @property
    def name(self) -> str:
        return f"{self.page.relative_to(ROOT)}:{self.line}"

    @property
    def lines(self) -> list[str]:
        """The commands of a shell block, without comments."""
        whole = self.text.replace("\\\n", " ").splitlines()
        return [line for line in whole if line.strip() and not line.startswith("#")]


def examples_of(page: Path) -> list[Example]:
    text = page.read_text(encoding="utf-8")
    return [
        Example(page, text.count("\n", 0, match.start(2)) + 1, match[2], match[3], match[1] or "")
        for match in FENCE.finditer(text)
    ]


EXAMPLES = [each for page in PAGES for each in examples_of(page)]
RUN = [each for each in EXAMPLES if not each.mark and each.language in (*SHELLS, "python")]


def test_an_example_says_what_it_is(subtests):
    for example in EXAMPLES:
        with subtests.test(example.name):
            assert example.language in LANGUAGES
            assert len(example.mark.split()) != 1, "Say what it needs, or of what it is the output."
            assert example.language != "json" or example.mark.startswith("Output")
            if example in RUN and example.language == "sh":  # nothing else is run here
                assert all(re.match(rf"curl |{re.escape(MANAGE)}", line) for line in example.lines)


def test_a_command_is_one_of_the_project(subtests):
    for example in (each for each in EXAMPLES if each.language in SHELLS):
        with subtests.test(example.name):
            check_commands(example)


def check_commands(example: Example) -> None:
    done = subprocess.run(["bash", "-n"], input=example.text, text=True, capture_output=True)
    assert not done.returncode, done.stderr
    for line in example.lines:
        before, is_command, words = line.partition(MANAGE)
        if is_command:
            words = re.sub(r"\$\([^)]*\)", "x", words.partition(" # ")[0])
            name, *arguments = shlex.split(words)
            command = load_command_class(get_commands()[name], name)
            given = ["x" if each == "…" else each for each in arguments]
            command.create_parser("manage.py", name).parse_args(given)
        for target in re.findall(r"\bmake (\w+)", before):
            assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), re.M)


def test_an_example_can_be_read(subtests):
    for example in EXAMPLES:
        with subtests.test(example.name):
            if example.language == "python":
                compile(example.text, example.name, "exec")
            elif example.language == "json":
                shown(example)


def shown(example: Example) -> dict:
    """Return what an output shows; ``…`` stands for the rest."""
    return json.loads(re.sub(r",\s*…\s*}", "}", example.text))


@pytest.fixture
def newcomer(
    transactional_db,
    live_server,
    superuser,
    parse_server,  # noqa: F811
    tmp_path,
    monkeypatch,
):
    """The folder of somebody who has just started the site, with a token in the environment."""
    if not (shutil.which("curl") and shutil.which("jq")):
        pytest.skip("needs curl and jq")
    load_starter_world(lambda _: None)
    parse_server.update()
    parse_server.find(STARTER_WORLD, None, 30)
    for name, who in (("TOKEN", superuser), ("SITE_TOKEN", superuser)):
        monkeypatch.setenv(name, ApiToken.issue(who, name)[1])
    monkeypatch.setenv("BASE", f"{live_server.url}/api/v1/worlds/{STARTER_WORLD}")
    monkeypatch.chdir(tmp_path)
    return tmp_path


class Session:
    """Runs the examples of one page, one after the other; those of a language share what they set."""

    def __init__(self, site: str) -> None:
        self.site = site
        self.shell = ""
        self.printed = ""
        answers = iter(ANSWERS)
        self.plans: list[object] = []
        self.names = {
            "token": os.environ["TOKEN"],
            "run": self.plans.append,
            "input": lambda _: next(answers),
        }

    def run(self, example: Example) -> None:
        """Run one example. Raises whatever goes wrong."""
        text = example.text.replace(SITE, self.site)
        if example.language == "python":
            with contextlib.redirect_stdout(io.StringIO()) as out:
                exec(compile(text, example.name, "exec"), self.names)
            self.printed = out.getvalue()
        elif text.startswith(MANAGE):
            for line in example.lines:
                call_command(*shlex.split(line.partition(MANAGE)[2].partition(" # ")[0]))
        else:
            self.bash(text)

    def bash(self, text: str) -> None:
        """Run a block in a shell that has what the blocks before it left: functions and variables."""
        state = Path("state.sh")
        state.touch()
        script = f"source ./{state}\n{text}\nstatus=$?\ndeclare -f > {state}\n"
        script += f"declare -p json made row etag split run upload API link key >> {state} 2>/dev/null || true"
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", script], capture_output=True, text=True, timeout=120
        )
        assert not done.returncode, f"{done.stdout[-2000:]}\n{done.stderr[-2000:]}"
        self.printed = done.stdout


@pytest.mark.processes
def test_the_examples_run_on_the_starter_world(newcomer, live_server):
    faults = []
    for page in PAGES:
        session = Session(live_server.url)
        for example in examples_of(page):
            try:
                if example in RUN:
                    session.run(example)
                elif example.mark.startswith("Output of the request"):
                    answer = json.loads(session.printed)
                    for name, value in shown(example).items():
                        assert (
                            answer[name] == pytest.approx(value, abs=0.01)
                            if isinstance(value, float)
                            else answer[name] == value
                        ), name
            except Exception as error:
                faults.append(f"{example.name}: {type(error).__name__}: {error}")
    assert not faults, "\n\n".join(faults)
    assert TrainingRun.objects.filter(world__name=STARTER_WORLD).exists()
    assert World.objects.filter(name=STARTER_WORLD).exists() and Entity.objects.exists()
