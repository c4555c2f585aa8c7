"""The templates, styles and scripts agree with each other, and templates can be read line by line."""

from __future__ import annotations

import re
from functools import cache
from itertools import chain
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TEMPLATES = sorted((ROOT / "templates").rglob("*.html"))
STYLES = sorted((ROOT / "static" / "css").glob("*.css"))
SCRIPTS = sorted((ROOT / "static" / "src").glob("*.js"))
LONGEST_LINE = 160

COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
RULE_HEAD = re.compile(r"([^{};]+)\{")
CLASS = re.compile(r"\.(-?[A-Za-z_][\w-]*)")
WORD = re.compile(r"-?[A-Za-z_][\w-]*")
# Where a class is given: attributes of templates and of HTML in Python, the class of the main element.
GIVEN = re.compile(r'class="([^"]*)"|main_class %\}([^{]*)')
TAG = re.compile(r"\{%.*?%\}|\{\{.*?\}\}", re.DOTALL)
STRING = re.compile(r'"([^"\n]*)"|`([^`]*)`')
# A class whose end is filled in: "status--{{ status }}", `tok-${name}`.
BEGINNING = re.compile(r"([\w-]*-)(?:\{\{|\$\{)")
# Set by CodeMirror, htmx and Django.
OF_LIBRARIES = ("cm-", "htmx-")
OF_DJANGO = {"errorlist", "helptext", "debug", "info", "success", "warning", "error"}
APPS = ("annotations", "parser_service", "gpsr_site")


@cache
def words_of_classes() -> set[str]:
    """Everything that may be a class in the templates, the scripts and the tags that render HTML."""
    python = chain.from_iterable((ROOT / app / "templatetags").glob("*.py") for app in APPS)
    given = [
        " ".join(each) for path in chain(TEMPLATES, python) for each in GIVEN.findall(read(path))
    ]
    strings = [" ".join(each) for path in SCRIPTS for each in STRING.findall(read(path))]
    return set(WORD.findall(TAG.sub(" ", " ".join(given)))) | set(WORD.findall(" ".join(strings)))


@cache
def beginnings() -> set[str]:
    """What the classes begin with whose ends are filled in."""
    found = (BEGINNING.findall(read(path)) for path in [*TEMPLATES, *SCRIPTS])
    return set(chain.from_iterable(found)) - {"-", ""}


@cache
def read(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def classes_of(style: Path) -> set[str]:
    """The classes in the selectors of a style sheet."""
    heads = RULE_HEAD.findall(COMMENT.sub("", read(style)))
    return set(CLASS.findall(" ".join(heads)))


def name_of(path: Path) -> str:
    return str(path.relative_to(ROOT))


def test_every_class_of_a_style_sheet_is_used():
    used = words_of_classes() | OF_DJANGO
    unused = {
        (name_of(style), name)
        for style in STYLES
        for name in classes_of(style)
        if name not in used and not name.startswith((*OF_LIBRARIES, *beginnings()))
    }
    assert not unused


def test_no_rule_of_one_class_alone_stands_twice():
    """The second place is overlooked when the first is changed. Rules for media are no second place."""
    heads = [
        head.strip()
        for style in STYLES
        for head in RULE_HEAD.findall(
            re.sub(
                r"@(?:media|container)[^{]*\{(?:[^{}]*\{[^{}]*\})*[^{}]*\}",
                "",
                COMMENT.sub("", read(style)),
            )
        )
    ]
    single = [head for head in heads if re.fullmatch(r"\.[\w-]+", head)]
    assert sorted({head for head in single if single.count(head) > 1}) == []


def test_lines_of_a_template_can_be_read():
    long = {
        f"{name_of(template)}:{number}": len(line)
        for template in TEMPLATES
        for number, line in enumerate(read(template).splitlines(), start=1)
        if len(line) > LONGEST_LINE
    }
    assert not long


def test_every_colour_and_measure_that_a_style_names_is_there():
    styles = "".join(COMMENT.sub("", read(path)) for path in STYLES)
    elsewhere = "".join(read(path) for path in [*SCRIPTS, *TEMPLATES])
    given = set(re.findall(r"(--[\w-]+)\s*:", styles + elsewhere))
    assert set(re.findall(r"var\((--[\w-]+)", styles)) <= given


def test_figures_are_rounded_by_one_filter():
    """Pages, reports and downloads round 66.25 alike, which Django's ``floatformat`` does not."""
    assert not [name_of(each) for each in TEMPLATES if re.search("floatformat:[1-9]", read(each))]


# One place reads keys, so that each shortcut obeys on every keyboard and none in a composition.
KEY_READ = re.compile(r"\b(?:event|e)\??\.(?:key|code|keyCode|which|isComposing)\b")
# The key of what a browser stores is none of a keyboard.
READERS_OF_KEYS = {"typing.js", "theme.js"}


def test_one_script_alone_reads_the_keyboard():
    readers = {script.name for script in SCRIPTS if KEY_READ.search(read(script))}
    assert readers == READERS_OF_KEYS, "ask keyOf of typing.js"


def test_whatever_moves_stands_still_where_somebody_wants_that():
    """``--motion`` is 0 there; a time of its own would go on moving."""
    moving = [
        f"{name_of(style)}: {declared}"
        for style in STYLES
        for declared in re.findall(r"(?:transition|animation)[\w-]*:[^;]+;", read(style))
        if re.search(r"\d(?:ms|s)\b", declared.replace("0s", ""))
    ]
    assert moving == []
