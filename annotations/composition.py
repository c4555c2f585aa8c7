"""Which files a task category is made of, as stored beside it.

An entry of its rule sources is a file name, or ``file.txt as $name`` where an import renames the
file's ``$Main``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from annotations.language.grammar_files import TEMPLATE_SUFFIX, GrammarFolder, resolve_import
from annotations.language.task_categories import Composition


def rule_sources(folder: GrammarFolder, name: str) -> list[str]:
    """The files with productions behind the file ``name``, each once, its imports before itself."""
    return list(dict.fromkeys(_with_imports(folder, name, "", set())))


def split_entry(entry: str) -> tuple[str, str]:
    """The file of a rule source, and the new name of its ``$Main`` where it has one."""
    source, _, alias = entry.partition(" as $")
    return source, alias


def template_sources(category: Composition) -> list[str]:
    """The template files of a category, its own last.

    Its own is named even where the files have none yet, so that what people write has a place.
    """
    own = own_template_source(category)
    return [name for name in category.template_files if name != own] + [own]


def own_template_source(category: Composition) -> str:
    """``X_semantics.txt`` for the category of ``X_grammar.txt`` or ``X.txt``, spelled as it is there."""
    stem = re.sub("_grammar$", "", category.grammar_file.rsplit(".", 1)[0], flags=re.IGNORECASE)
    own = stem + TEMPLATE_SUFFIX
    found = (name for name in category.template_files if name.lower() == own.lower())
    return next(found, own)


def owners(categories: Iterable[Composition]) -> dict[str, str]:
    """File → the task category that it was written for; shared files have none."""
    names: dict[str, str] = {}
    for category in categories:
        names[category.grammar_file] = category.name
        names[own_template_source(category)] = category.name
    return names


def _with_imports(
    folder: GrammarFolder, name: str, alias: str, taken: set[tuple[str, str]]
) -> Iterator[str]:
    taken.add((name, alias))
    for directive in folder.files[name].imports:
        target = resolve_import(directive.path, folder.files)
        inner = directive.alias or alias
        if target is not None and (target, inner) not in taken:
            yield from _with_imports(folder, target, inner, taken)
    if folder.files[name].productions:
        yield f"{name} as ${alias}" if alias else name
