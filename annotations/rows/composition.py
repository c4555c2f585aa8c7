"""Which files a task category is made of, as stored beside it.

An entry of its rule sources is a file name, or ``file.txt as $name`` where an import renames the
file's ``$Main``.
"""

from __future__ import annotations

from collections.abc import Iterable

from annotations.language.grammar import GrammarFolder
from annotations.language.templates import Composition
from annotations.models import TaskCategory


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
