"""Which files of a folder make which task category (FORMATS §3)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from annotations.language.grammar import ROOT
from annotations.language.grammar_files import TEMPLATE_SUFFIX
from annotations.language.productions import GrammarFile

_NUMBERED = re.compile(r"(?P<prefix>.*)category_?(?P<number>\d+)", re.IGNORECASE)
# Category 2 reuses the templates of category 1; every other one has only its own.
_INHERITED = {"2": ("1",)}


@dataclass(frozen=True, slots=True)
class Composition:
    """One task category: its name, the file with its ``$Main`` and its template files in order.

    In a set of templates a later one wins, so a category's own file stands last.
    """

    name: str
    grammar_file: str
    template_files: tuple[str, ...]


def compose(
    grammar_files: Mapping[str, GrammarFile], file_names: Iterable[str]
) -> tuple[Composition, ...]:
    """The task categories of a folder: numbered ones first, then the others by name.

    Args:
        grammar_files: the grammars of the folder by file name.
        file_names: the names of all its files; template files are picked from them.

    A file with ``$Main`` whose stem ends in ``category_N`` is category N; any other one is named by
    its stem (without ``_grammar``). ``X_grammar.txt`` and ``X.txt`` go with ``X_semantics.txt``.
    """
    templates = {name.lower(): name for name in file_names if is_template_name(name)}
    roots = sorted(name for name, file in grammar_files.items() if file.defines(ROOT))
    bases = {name: _base(name) for name in roots}
    names = {name: _category_name(base, bases.values()) for name, base in bases.items()}
    found = (
        Composition(names[file], file, _template_files(base, templates))
        for file, base in bases.items()
    )
    return tuple(sorted(found, key=_order))


def is_template_name(name: str) -> bool:
    """Whether a file of this name holds semantic templates."""
    return name.lower().endswith(TEMPLATE_SUFFIX)


def _base(file_name: str) -> str:
    stem = file_name.rsplit(".", 1)[0]
    return re.sub("_grammar$", "", stem, flags=re.IGNORECASE)


def _category_name(base: str, bases: Iterable[str]) -> str:
    """The number of a numbered base, where no second family of files claims the same number."""
    found = _NUMBERED.fullmatch(base)
    if found is None:
        return base
    rivals = (_NUMBERED.fullmatch(other) for other in bases)
    claims = sum(rival is not None and rival["number"] == found["number"] for rival in rivals)
    return found["number"] if claims == 1 else base


def _template_files(base: str, templates: Mapping[str, str]) -> tuple[str, ...]:
    found = _NUMBERED.fullmatch(base)
    inherited = _INHERITED.get(found["number"], ()) if found is not None else ()
    bases = (*(re.sub(r"\d+$", number, base) for number in inherited), base)
    names = (f"{each}{TEMPLATE_SUFFIX}".lower() for each in bases)
    return tuple(templates[name] for name in names if name in templates)


def _order(composition: Composition) -> tuple[bool, int, str]:
    name = composition.name
    return (not name.isdigit(), int(name) if name.isdigit() else 0, name)
