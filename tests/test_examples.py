"""The examples that a newcomer meets run as they are, on the starter world as ``make run`` leaves it.

A block of any document runs, unless the line above it is one of ``*Needs …*`` (a server, a folder, an hour),
``*Output …*`` and ``*File …*``, for people to read. What needs something is checked by the parsers of its commands, or
by the options that its module has. Commands within sentences and tables are checked in the same way.
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

from annotations.exchange.predicates_file import read_predicates
from annotations.exchange.shipped_worlds import SHIPPED_WORLDS
from annotations.exchange.starter_world import STARTER_WORLD, load_starter_world
from annotations.language.forms import read_form
from annotations.language.plans import apply_recipes, default_book, make_plan, usual_places
from annotations.language.templates import read_generator_folder
from annotations.models import ApiToken, Entity, World
from parser_service.models import TrainingRun
from parser_service.parsers.interface import Knowledge
from parser_service.parsers.oracle import GrammarOracle
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.clients.conftest import CLIENT
from tests.parser_service.live_server import parse_server  # noqa: F401

ROOT = Path(__file__).resolve().parent.parent
PAGES = [
    ROOT / "README.md",
    *sorted((ROOT / "docs" / "guides").glob("*.md")),
    *sorted(ROOT.glob("[A-QS-Z]*.md")),
    *(path for path in sorted((ROOT / "docs").rglob("*.md")) if path.parent.name != "guides"),
    CLIENT / "README.md",
]
PAGES.sort(key=lambda path: path.name == "rest.md")  # last: it changes the world
FENCE = re.compile(
    r"^(?:\*((?:Needs|Output|File)\b[^*]+)\*\n\n?)?```([\w-]*)\n(.*?)^```", re.M | re.S
)
INDENTED = re.compile(
    r"^ {4}(?:[A-Z_]+=\S* )*(?:\.venv/bin/|python |gpsr-workbench |pip |make |curl )", re.M
)
SHELLS = ("sh", "bash")
FILES = ("bibtex", "ini", "nginx", "toml", "xml", "yaml")  # of other programs
LANGUAGES = {*SHELLS, *FILES, "python", "json", "text"}
MANAGE = ".venv/bin/python manage.py "
MODULE = re.compile(r"(?<!\S)(?:\.venv/bin/)?python -m ([\w.]+)")
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
        whole = self.text.replace("\\\n", "").splitlines()
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
            assert example.language != "json" or example.mark.startswith(("Output", "File"))
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
        if module := MODULE.search(before):
            check_options(module[1], before[module.end() :])
        for target in re.findall(r"\bmake (\w+)", before):
            assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), re.M)


def check_options(module: str, words: str) -> None:
    """Check that a module of ours is there and names each option, itself or in a file beside it."""
    if module.split(".")[0] not in ("benchmarks", "tests"):
        return
    path = ROOT / module.replace(".", "/")
    path = path.with_suffix(".py") if not path.is_dir() else path / "__main__.py"
    beside = "".join(each.read_text(encoding="utf-8") for each in path.parent.glob("*.py"))
    for option in re.findall(r"(?<!\S)\[?(--[a-z-]+)", words.partition(" # ")[0]):
        assert option == "--help" or f'"{option}"' in beside, f"{module} {option}"


def test_commands_within_sentences_and_tables_are_understood(subtests):
    """Their names and options; what stands for a value may be anything."""
    names = get_commands()
    parsers = {}
    for page in PAGES:
        text = FENCE.sub("", page.read_text(encoding="utf-8"))
        for said in re.findall(r"`([^`\n]+)`", text):
            words = re.sub(r"^(?:\.venv/bin/python )?manage\.py |^gpsr-workbench manage ", "", said)
            name, *rest = words.split()
            is_command = words != said or (page.name == "commands.md" and rest and name in names)
            if not is_command or not name.islower() or name == "help":
                continue
            with subtests.test(f"{page.name}: {said}"):
                assert name in names
                if name not in parsers:
                    command = load_command_class(names[name], name)
                    parsers[name] = command.create_parser("manage.py", name)
                given = {each for each in rest if re.fullmatch(r"--[a-z-]+", each)}
                assert given <= set(parsers[name]._option_string_actions)


def test_no_command_is_only_indented():
    """It would not be checked: a fence with its language is."""
    assert not [
        (page.name, match[0])
        for page in PAGES
        for match in INDENTED.finditer(FENCE.sub("", page.read_text("utf-8")))
    ]


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


def language_of_the_world() -> dict[str, object]:
    """What the documents of the pure core call the parts of a world, here of ``competition``."""
    folder = SHIPPED_WORLDS["competition"].folder
    ontology, _ = read_ontology_folder(folder)
    predicates = read_predicates(
        (folder / "predicates.json").read_bytes(), classes=ontology.classes
    )
    categories = read_generator_folder(folder).categories()
    form = '(bring (λ$1:e (is_a $1 "quince") (at $1 "larder")))'
    count = '(say (count (λ$1:e (is_a $1 "drinks") (at $1 "larder"))))'
    greet = '(greet (λ$1:e (person $1) (name $1 "Maria") (at $1 "piano")))'
    book = default_book()
    plans = [
        apply_recipes(
            make_plan(read_form(each), ontology, predicates), book, usual_places(ontology)
        )
        for each in (form, count, greet)
    ]
    return {
        **{"ontology": ontology, "predicates": predicates, "action_names": {}, "book": book},
        **{"form": read_form(form), "evidence": None, "judge": None},
        **dict(zip(("first", "second", "third"), plans, strict=True)),
        "utterance": "My first wish is: bring me the quince. Then greet Maria in the lobby.",
        "oracle": GrammarOracle(knowledge=Knowledge(ontology=ontology, grammar=categories)),
    }


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
            **language_of_the_world(),
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
