"""Decide which files of a folder make which task category (FORMATS §3)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from annotations.language.grammar import ROOT, TEMPLATE_SUFFIX, GrammarFile

_NUMBERED = re.compile(r"(?P<prefix>.*)category_?(?P<number>\d+)", re.IGNORECASE)
# Category 2 reuses the templates of category 1; every other one has only its own.
_INHERITED = {"2": ("1",)}


@dataclass(frozen=True, slots=True)
class Composition:
    """One task category: its name, the file with its ``$Main`` and its template files in order.

    A later template wins, so a category's own file comes last.
    """

    name: str
    grammar_file: str
    template_files: tuple[str, ...]

    @property
    def own_template_file(self) -> str:
        """``X_semantics.txt`` for ``X_grammar.txt`` or ``X.txt``, whether it exists or not.

        A file that exists keeps its own spelling.
        """
        own = _base(self.grammar_file) + TEMPLATE_SUFFIX
        return next((name for name in self.template_files if name.lower() == own.lower()), own)


def compose(
    grammar_files: Mapping[str, GrammarFile], file_names: Iterable[str]
) -> tuple[Composition, ...]:
    """Return the task categories of a folder: numbered ones first, then the others by name.

    Args:
        grammar_files: the grammars of the folder by file name.
        file_names: the names of all its files; template files are picked from them.

    A file with ``$Main`` whose stem ends in ``category_N`` is category N; any other one is named after
    its stem (without ``_grammar``). ``X_grammar.txt`` and ``X.txt`` go with ``X_semantics.txt``.
    """
    templates = {name.lower(): name for name in file_names if is_template_name(name)}
    roots = sorted(name for name, file in grammar_files.items() if file.defines(ROOT))
    bases = {name: _base(name) for name in roots}
    names = {name: _category_name(base, bases.values()) for name, base in bases.items()}
    compositions = (
        Composition(names[file], file, _template_files(base, templates))
        for file, base in bases.items()
    )
    return tuple(sorted(compositions, key=_order))


def is_template_name(name: str) -> bool:
    """Return whether a file of this name holds semantic templates."""
    return name.lower().endswith(TEMPLATE_SUFFIX)


def _base(file_name: str) -> str:
    stem = file_name.rsplit(".", 1)[0]
    return re.sub("_grammar$", "", stem, flags=re.IGNORECASE)


def _category_name(base: str, bases: Iterable[str]) -> str:
    """Return the number of a numbered base, unless other files claim the same number."""
    match = _NUMBERED.fullmatch(base)
    if match is None:
        return base
    rivals = (_NUMBERED.fullmatch(other) for other in bases)
    claims = sum(rival is not None and rival["number"] == match["number"] for rival in rivals)
    return match["number"] if claims == 1 else base


def _template_files(base: str, templates: Mapping[str, str]) -> tuple[str, ...]:
    match = _NUMBERED.fullmatch(base)
    inherited = _INHERITED.get(match["number"], ()) if match is not None else ()
    bases = (*(re.sub(r"\d+$", number, base) for number in inherited), base)
    names = (f"{each}{TEMPLATE_SUFFIX}".lower() for each in bases)
    return tuple(templates[name] for name in names if name in templates)


def _order(composition: Composition) -> tuple[bool, int, str]:
    name = composition.name
    return (not name.isdecimal(), int(name) if name.isdecimal() else 0, name)
