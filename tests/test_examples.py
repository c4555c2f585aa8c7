"""The examples that a newcomer meets can be run, or say what they need.

A block of README, guides, REST and the client either runs as it stands, or the line above it is one of ``*Needs …*`` (a
server, a folder, an hour) and ``*Output …*``, for people to read. Every command is read by its own parser. Those of
REST and the client are run by ``test_api_docs.py`` and ``clients/test_python_client.py``.
"""

from __future__ import annotations

import json
import re
import shlex
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest
from django.core.management import get_commands, load_command_class

ROOT = Path(__file__).resolve().parent.parent
PAGES = [
    ROOT / "README.md",
    *sorted((ROOT / "docs" / "guides").glob("*.md")),
    ROOT / "clients" / "python" / "README.md",
    ROOT / "docs" / "reference" / "rest.md",
]
FENCE = re.compile(r"^(?:\*((?:Needs|Output)\b[^*]+)\*\n\n?)?```(\w*)\n(.*?)^```", re.M | re.S)
SHELLS, LANGUAGES = ("sh", "bash"), {"sh", "bash", "python", "json", "text"}
MANAGE = ".venv/bin/python manage.py "


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
RUN = [each for each in EXAMPLES if not each.mark and each.language not in ("text", "json")]


def by_name(examples):
    return pytest.mark.parametrize("example", examples, ids=lambda each: each.name)


@by_name(EXAMPLES)
def test_an_example_says_what_it_is(example):
    assert example.language in LANGUAGES
    assert len(example.mark.split()) != 1, "Say what it needs, or of what it is the output."
    assert example.language != "json" or example.mark.startswith("Output")
    if example in RUN and example.language == "sh":  # nothing else is run here
        assert all(re.match(rf"curl |{re.escape(MANAGE)}", line) for line in example.lines)


@by_name([each for each in EXAMPLES if each.language in SHELLS])
def test_a_command_is_one_of_the_project(example):
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


@by_name([each for each in EXAMPLES if each.language in ("python", "json")])
def test_an_example_can_be_read(example):
    if example.language == "python":
        compile(example.text, example.name, "exec")
    else:
        shown(example)


def shown(example: Example) -> dict:
    """Return what an output shows; ``…`` stands for the rest."""
    return json.loads(re.sub(r",\s*…\s*}", "}", example.text))
