"""The README, the docs and the code say the same."""

from __future__ import annotations

import json
import re
import shlex
import tomllib
from pathlib import Path

import pytest
import yaml
from django.core.management import get_commands, load_command_class

from parser_service.parsers.registry import parsers
from parser_service.results.published import PUBLISHED, published_accuracy

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
PACKAGES = ("annotations", "parser_service", "gpsr_site", "tests")
README = (ROOT / "README.md").read_text(encoding="utf-8")
VARIABLES = (DOCS / "reference" / "variables.md").read_text(encoding="utf-8")
COMMANDS = (DOCS / "reference" / "commands.md").read_text(encoding="utf-8")
PAGES = [
    *sorted(ROOT.glob("*.md")),
    *sorted(DOCS.rglob("*.md")),
    ROOT / "clients" / "python" / "README.md",
]
SETTINGS = (ROOT / "gpsr_site" / "settings.py").read_text(encoding="utf-8")
LINK = re.compile(r"\]\((?!https?:)([^)#\s]*)(?:#([^)\s]*))?\)")
MODULE = re.compile(r"python -m ((?:benchmarks|tests)[\w.]*)")
FILE = re.compile(r"`((?:annotations|benchmarks|gpsr_site|parser_service|tests)/[\w./-]*)`")
TABLE_ROW = re.compile(r"^\| `([A-Z_]+)` \|", re.MULTILINE)
# Django's and Celery's own; read by the shell, the tests or a library rather than by the settings.
READ_ELSEWHERE = {
    "GPSR_ENGLISH_DIR",
    "GPSR_SHARED_DATA",
    "TEST_DATABASE_URL",
    "TEST_BROKER_URL",
    "TEST_KILLS",
    "TEST_WALK",
    "TEST_SCHEMA_CASES",
}


def variables_of_the_settings() -> set[str]:
    return set(re.findall(r'env(?:\.\w+)?\(\s*"([A-Z_]+)"', SETTINGS)) | set(
        re.findall(r'_required_when_served\("([A-Z_]+)"', SETTINGS)
    )


def test_every_variable_of_the_settings_is_documented_and_no_other():
    assert set(TABLE_ROW.findall(VARIABLES)) - READ_ELSEWHERE == variables_of_the_settings()


def test_variables_of_the_tests_are_documented():
    assert set(TABLE_ROW.findall(VARIABLES)) >= READ_ELSEWHERE


@pytest.mark.parametrize("target", ["run", "test", "docs"])
def test_the_commands_of_the_readme_exist_in_the_makefile(target):
    assert f"make {target}" in README
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), re.MULTILINE)


@pytest.mark.parametrize(
    "line", re.findall(r"^\.venv/bin/python manage\.py (.*)$", README, re.MULTILINE)
)
def test_the_commands_of_the_readme_are_understood(line):
    name, *arguments = shlex.split(line)
    command = load_command_class(get_commands()[name], name)
    command.create_parser("manage.py", name).parse_args(arguments)


def test_every_target_of_the_makefile_is_documented():
    [targets] = re.findall(r"^\.PHONY: (.*)$", (ROOT / "Makefile").read_text(), re.MULTILINE)
    assert set(re.findall(r"^\| `make (\w+)` \|", COMMANDS, re.MULTILINE)) == set(targets.split())


def test_every_management_command_is_documented():
    folders = ROOT.glob("*/management/commands")
    commands = {path.stem for folder in folders for path in folder.glob("[a-z]*.py")}
    missing = {name for name in commands if f"| `{name}" not in COMMANDS}
    assert not missing


def links_of(page: Path) -> set[tuple[Path, str]]:
    """Return what a page links to, outside its code: a file, and the heading in it or nothing."""
    text = re.sub(r"^    .*$|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    targets = LINK.findall(text)
    return {
        ((page.parent / path).resolve() if path else page, heading) for path, heading in targets
    }


def headings_of(page: Path) -> set[str]:
    """Return the headings of a page as links write them."""
    titles = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}


def test_links_lead_to_files_and_to_headings_in_them():
    missing = [
        (page.name, f"{target}#{heading}")
        for page in PAGES
        for target, heading in links_of(page)
        if not target.exists() or (heading and heading not in headings_of(target))
    ]
    assert missing == []


def test_files_and_modules_that_a_page_names_are_there():
    missing = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        missing += [(page.name, path) for path in FILE.findall(text) if not (ROOT / path).exists()]
        for name in MODULE.findall(text):
            path = ROOT / name.replace(".", "/")
            if not (path.with_suffix(".py").exists() or (path / "__main__.py").exists()):
                missing.append((page.name, name))
    assert missing == []


DOTTED = re.compile(r"``((?:\w+\.)+(?!json)\w+)``")


def test_modules_that_docstrings_name_are_there():
    """By their whole path, such as ``parser_service.analysis.sureness``; it may go on with a name in the module."""
    paths = [path for each in PACKAGES for path in (ROOT / each).rglob("*.py")]
    rooms = {path.parent.name for path in paths}
    wrong = [
        (path.name, name)
        for path in paths
        for name in DOTTED.findall(path.read_text(encoding="utf-8"))
        if name.split(".")[0] in rooms and not is_module(name)
    ]
    assert wrong == []


def is_module(name: str) -> bool:
    """Whether it is a module or a package, or the part before its last dot is."""
    path = ROOT / name.replace(".", "/")
    return any(each.is_dir() or each.with_suffix(".py").exists() for each in (path, path.parent))


QUOTED = re.compile(r"`([^`\n]+)`")
PATH = re.compile(r"[\w.-]*/[\w<>./-]*")
NAME = re.compile(r"[*@]?([A-Za-z_]\w*(?:\.\w+)*)(?:\(.*\))?")
# "`NAME` in `FILE`", "`NAME` (`FILE`)": the file has it.
PLACED = re.compile(r"`([A-Za-z_][\w.]*)(?:\([^`]*\))?`(?: in| of|,? \() ?`(\w+/[\w/.-]+\.py)`")
NO_NAMES = {"utils.py", "services.py"}  # which there are not


def test_what_contributing_names_is_there():
    """Its paths, with ``<room>`` for any, lead somewhere. Its names are in the code, and in the file that it says."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    words = {
        word
        for folder in PACKAGES
        for path in (ROOT / folder).rglob("*.py")
        for word in re.findall(r"\w+", path.read_text(encoding="utf-8"))
    }
    missing = []
    for said in sorted({*QUOTED.findall(text)} - NO_NAMES):
        if PATH.fullmatch(said):
            if not any(ROOT.glob(re.sub(r"<\w+>", "*", said).strip("/"))):
                missing.append(said)
        elif (name := NAME.fullmatch(said)) and not words.issuperset(name[1].split(".")):
            missing.append(said)
    for name, path in PLACED.findall(text):
        if name.rpartition(".")[2] not in (ROOT / path).read_text(encoding="utf-8"):
            missing.append(f"{name} in {path}")
    assert missing == []


def test_every_page_of_the_docs_is_in_the_navigation_and_on_the_first_page():
    pages = {str(page.relative_to(DOCS)) for page in DOCS.rglob("*.md")}
    settings = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    navigation = re.findall(r"^ +- (?:\w+: )?([\w/-]+\.md)$", settings, re.MULTILINE)
    assert sorted(navigation) == sorted(pages)
    first = DOCS / "index.md"
    assert pages == {str(target.relative_to(DOCS)) for target, _ in links_of(first)} | {"index.md"}


def test_links_of_the_docs_stay_in_the_docs():
    """The site has these pages alone: code and files beside them are named, not linked."""
    links = {(page, target) for page in DOCS.rglob("*.md") for target, _ in links_of(page)}
    assert not [each for each in links if not each[1].is_relative_to(DOCS)]


def test_the_figures_of_the_paper_are_those_that_the_results_page_shows():
    text = (DOCS / "research" / "reproducing.md").read_text(encoding="utf-8")
    tables = zip(("command", "logical_form"), text.split("\n## By ")[1:3], strict=True)
    for criterion, table in tables:
        rows = re.findall(r"^\| `([\w-]+)` \| (.*) \|$", table, re.MULTILINE)
        assert {name for name, _ in rows} == set(PUBLISHED)
        for name, cells in rows:
            theirs = [float(cell.split(" / ")[0]) for cell in cells.split(" | ")]
            settings = (("gen", "gen"), ("gen", "para"), ("para", "para"), ("gen+para", "para"))
            assert theirs == [published_accuracy(name, each, criterion) for each in settings], name


def test_every_picture_is_shown_described_and_small():
    pages = [ROOT / "README.md", *DOCS.rglob("*.md")]
    shown = {}
    for page in pages:
        for said, target in re.findall(
            r"!\[([^]]*)\]\(([^)]*)\)", page.read_text(encoding="utf-8")
        ):
            shown[(page.parent / target).resolve()] = said
    images = set((DOCS / "images").iterdir())
    assert shown.keys() == images
    assert not [image for image, said in shown.items() if len(said.split()) < 5]
    assert not [each.name for each in images if each.stat().st_size > 160_000]


def test_whoever_looks_for_table_3_finds_it_in_the_readme_and_one_click_on():
    page = DOCS / "research" / "reproducing.md"
    assert "## Reproduce Table 3\n\n**[Reproduce Table 3](docs/research/reproducing.md)**" in README
    assert page.read_text(encoding="utf-8").startswith("# Reproduce Table 3\n")


def test_the_readme_has_the_figures_of_the_docs():
    """Its table of the paper is a part of the page about it, which names the commands."""
    text = (DOCS / "research" / "reproducing.md").read_text(encoding="utf-8")
    rows = set(re.findall(r"^\| `[\w-]+` \| .*$", README, re.MULTILINE))
    assert len(rows) == 4 and rows <= set(text.splitlines())


COLUMNS = ("gen-gen", "gen-para", "para-para", "gen+para-para")  # of the tables of the paper


def test_figures_of_the_test_part_are_those_that_were_measured(shared_data):
    """They are the last of each cell of Table 3: on the page about it, by command and by form, and in the README."""
    file = shared_data / "test-figures.json"
    cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
    measured = {
        tuple(cell[key] for key in ("parser", "criterion", "setting", "protocol")): cell
        for cell in cells
    }
    page = (DOCS / "research" / "reproducing.md").read_text(encoding="utf-8")
    by_command, by_form = page.split("## By form")
    rows = 0
    for text, criterion in (
        (by_command, "command"),
        (by_form, "logical_form"),
        (README, "command"),
    ):
        for name, row in re.findall(
            r"^\| `([\w-]+)`[\w, ]*((?: \|[^|\n]* / [^|\n]*)+) \|$", text, re.M
        ):
            protocol = "grammar" if name == "grammar-oracle" else "strict"
            for setting, shown in zip(COLUMNS, row.split("|")[1:], strict=True):
                cell = measured.get((name, criterion, setting, protocol))
                expected = f"{100 * cell['accuracy_test']:.1f}" if cell else "–"
                assert shown.split("/")[-1].strip() == expected, (name, criterion, setting)
            rows += 1
    assert rows == 10 + 8 + 6
    for key in (
        ("ranker", "command", "gen-gen", "domain"),
        ("ranker", "command", "gen-para", "domain"),
        ("ranker", "logical_form", "gen+para-para", "domain"),
        ("ranker", "logical_form", "gen+para-para", "strict"),
        ("ranker", "logical_form", "gen-gen", "strict"),
        ("ranker", "logical_form", "para-para", "domain"),
    ):
        assert f"{100 * measured[key]['accuracy_test']:.1f}" in page, key
    for key in (
        ("ranker", "command", "gen+para-para", "strict"),
        ("ranker", "logical_form", "gen+para-para", "strict"),
    ):
        low, high = measured[key]["interval_test"]
        assert f"{100 * low:.1f}–{100 * high:.1f}" in page, key


def test_the_file_for_citations_names_this_version_and_the_paper():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    page = (DOCS / "research" / "citing.md").read_text(encoding="utf-8")
    assert cited["cff-version"] == "1.2.0" and cited["message"]
    assert (cited["version"], cited["license"]) == (project["version"], project["license"])
    assert f"version = {{{cited['version']}}}" in page
    paper, corpus = cited["references"]
    for each in (paper["title"], corpus["title"], corpus["doi"]):
        assert each in page and each


def test_installing_names_every_extra_that_is_not_for_developers():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    page = (DOCS / "guides" / "installing.md").read_text(encoding="utf-8").partition("## Extras")[2]
    extras = set(re.findall(r"^\| `(\w+)` \|", page.partition("\n## ")[0], re.MULTILINE))
    assert extras == project["optional-dependencies"].keys() - {"docs", "test"}


def test_what_troubleshooting_quotes_is_what_the_program_says():
    page = (DOCS / "guides" / "troubleshooting.md").read_text(encoding="utf-8")
    paths = [
        *(path for each in PACKAGES[:3] for path in (ROOT / each).rglob("*.py")),
        *(ROOT / "templates").rglob("*.html"),
        ROOT / "Makefile",
    ]
    text = "".join(path.read_text(encoding="utf-8") for path in paths)
    text = re.sub(r'"\s*\n\s*f?"', "", text)  # a sentence goes on in the next line
    first = re.findall(r"^\| (“.*?) \| ", page, re.MULTILINE)
    quoted = [each for row in first for each in re.findall(r"“(.*?)”(?:, “|$| and)", row)]
    assert len(quoted) >= 20
    words = {  # what stands for a name or a number there
        *("127.0.0.1:8000: Address already in use", "0.0.0.0", "0xe9", "7 of ranker"),
        *("8 …; train it again", "…", "(connection failed", "full", "read-only", "Worlds here:"),
        *("SECRET_KEY", "worker"),
    }
    missing = []
    for each in quoted:
        parts = re.split("|".join(map(re.escape, sorted(words, key=len, reverse=True))), each)
        missing += [part for part in parts if part.strip(" ,=“”") and part.strip() not in text]
    assert missing == []


def test_the_table_of_the_paper_is_called_as_the_paper_calls_it():
    for page in (README, (DOCS / "research" / "reproducing.md").read_text(encoding="utf-8")):
        assert "Table 3" in page


def test_every_parser_has_a_row_and_the_name_of_its_page():
    table = (DOCS / "design" / "parsers.md").read_text(encoding="utf-8").partition("\n## ")[0]
    for name, entry in parsers().items():
        assert f"`{name}`, {entry.title}" in table, name


def test_every_page_is_reached_from_the_readme():
    reached, todo = set(), [ROOT / "README.md"]
    while todo:
        page = todo.pop()
        if page not in reached and page.suffix == ".md":
            reached.add(page)
            todo += [target for target, _ in links_of(page)]
    assert not set(PAGES) - reached
