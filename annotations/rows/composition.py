"""Which files a task category is made of, as stored beside it.

An entry of its rule sources is a file name, or ``file.txt as $name`` where an import renames the
file's ``$Main``. Sets that people begin are named as files too, so that a download of the world can be imported.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from annotations.language.grammar import GrammarFolder
from annotations.language.templates import Composition
from annotations.language.texts import LanguageError
from annotations.models import Grammar, TaskCategory, World

FIRST_CATEGORY = "general"  # of a world whose first production or template says no other
RULES, TEMPLATES = "_grammar.txt", "_semantics.txt"
_NAME = re.compile(r"\w[\w -]*")


def require_set_name(name: str) -> None:
    """Raise LanguageError unless a task category, or a set, can have this name: it becomes that of a file."""
    if not _NAME.fullmatch(name):
        raise LanguageError(
            f"“{name[:60]}” cannot be a name here", hint="use letters, digits, blanks, _ and -"
        )


def set_called(text: str, ending: str, known: Iterable[str]) -> str:
    """Return the file name of a set that a person calls ``text``: one of ``known``, or ``plants_grammar.txt``."""
    if text.lower().endswith(".txt"):
        return text
    return {plain_name(each): each for each in known}.get(text, f"{text}{ending}")


def plain_name(source: str) -> str:
    """Return what a person calls the set ``source``."""
    for ending in (RULES, TEMPLATES, ".txt"):
        if source.lower().endswith(ending):
            return source[: -len(ending)]
    return source


def new_category(grammar: Grammar | None, name: str) -> TaskCategory:
    """Return an unsaved task category with sets of its own, named after it."""
    return TaskCategory(
        grammar=grammar,
        name=name,
        rule_sources=[f"{name}{RULES}"],
        template_sources=[f"{name}{TEMPLATES}"],
    )


def categories_to_write_for(world: World, first: str = FIRST_CATEGORY) -> list[TaskCategory]:
    """Return the task categories; in an empty world the one, called ``first``, that its first row makes."""
    stored = list(TaskCategory.objects.filter(grammar__world=world))
    return stored or [new_category(None, first)]


def rule_files(categories: Iterable[TaskCategory]) -> list[str]:
    """Return the sets of productions that the categories are made of, each once."""
    entries = (entry for category in categories for entry in category.rule_sources)
    return list(dict.fromkeys(split_entry(entry)[0] for entry in entries))


def rule_sources(folder: GrammarFolder, name: str) -> list[str]:
    """Return the files with productions behind the file ``name``, each once, its imports before itself."""
    sources = folder.sources(name)
    return [f"{source} as ${alias}" if alias else source for source, alias in sources]


def split_entry(entry: str) -> tuple[str, str]:
    """Return the file of a rule source, and the new name of its ``$Main`` where it has one."""
    source, _, alias = entry.partition(" as $")
    return source, alias


def template_sources(category: Composition) -> list[str]:
    """Return the template files of a category, its own last.

    Its own is named even where the files have none yet, so that what people write has a place.
    """
    own = category.own_template_file
    return [name for name in category.template_files if name != own] + [own]


def owners(categories: Iterable[Composition]) -> dict[str, str]:
    """Return file → the task category that it was written for; shared files have none."""
    names: dict[str, str] = {}
    for category in categories:
        names[category.grammar_file] = category.name
        names[category.own_template_file] = category.name
    return names


def own_category(categories: Iterable[TaskCategory], source: str) -> str:
    """Return the name of the task category that the file ``source`` was written for; empty for a shared one."""
    own = (each.name for each in categories if split_entry(each.rule_sources[-1])[0] == source)
    return next(own, "")
