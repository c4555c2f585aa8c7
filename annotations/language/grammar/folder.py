"""A folder of grammar files: which files are grammars, and what each one imports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath

from annotations.language.decoding import decode
from annotations.language.errors import LanguageError, Position, Problem, error_at
from annotations.language.grammar.comments import Import
from annotations.language.grammar.grammar import ROOT, Grammar
from annotations.language.grammar.productions import GrammarFile, Production, read_productions
from annotations.language.grammar.renaming import rename

TEMPLATE_SUFFIX = "_semantics.txt"
# Text files of a generator folder that belong to the ontology (FORMATS §2).
_ONTOLOGY_TEXTS = frozenset({"categories.txt", "whattosay.txt"})
# Grounded triples (FORMATS §6) that may be in the same folder.
TRIPLE_FILES = frozenset({"paraphrases.txt", "paraphrasings.txt"})
# GPSRCmdGen's files import the first name, but the file has one of the others.
_ALIASES = {"common.txt": ("common_rules.txt", "commonrules.txt")}


@dataclass(frozen=True, slots=True)
class GrammarFolder:
    """The grammar files of a folder by name, and every problem of reading them.

    Problems of a grammar as a whole (``Grammar.problems``) are not included.
    """

    files: Mapping[str, GrammarFile]
    problems: tuple[Problem, ...]

    def grammar(self, name: str) -> Grammar:
        """Return the productions of the file ``name`` after those it imports, each file taken once."""
        return Grammar(
            tuple(
                production
                for source, alias in self.sources(name)
                for production in apply_alias(self.files[source].productions, alias)
            )
        )

    def sources(self, name: str) -> tuple[tuple[str, str], ...]:
        """Return the files with productions that make up the file ``name``: its imports, then itself.

        Each comes with the alias that ``import file.txt as $alias`` gives its ``$Main``, or with an
        empty one. An alias applies to everything that is imported, until a nested import gives
        another; a file is taken once for each alias.
        """
        return tuple(_follow_imports(self.files, name, "", set()))


def read_grammar_files(contents: Mapping[str, bytes]) -> GrammarFolder:
    """Read the grammar files among ``contents`` (file name → bytes).

    Every ``*.txt`` is a grammar file except templates, the two text files of the ontology and
    triples.
    """
    files: dict[str, GrammarFile] = {}
    problems: list[Problem] = []
    for name in sorted(filter(is_grammar_name, contents)):
        try:
            files[name] = read_productions(decode(contents[name], name), name)
            problems.extend(files[name].problems)
        except LanguageError as error:
            problems.append(error.problem)
    if not files and not problems:
        problems.append(
            error_at(Position(), "there is no grammar here", "add a file like gpsr.txt")
        )
    problems.extend(_import_problems(files, contents))
    return GrammarFolder(files, tuple(problems))


def is_grammar_name(name: str) -> bool:
    """Return whether a file with this name in a generator folder is a grammar."""
    lower = name.lower()
    return (
        lower.endswith(".txt")
        and not lower.endswith(TEMPLATE_SUFFIX)
        and lower not in _ONTOLOGY_TEXTS | TRIPLE_FILES
    )


def resolve_import(path: str, names: Mapping[str, object]) -> str | None:
    """Return the file that an import means: the same name, ignoring case, or one of its other names.

    Returns:
        A key of ``names``, or None if there is no such file.

    Raises:
        LanguageError: the path leads out of the folder (without position).
    """
    parts = PurePosixPath(path.replace("\\", "/")).parts
    if not parts or parts[0] == "/" or ".." in parts or ":" in path:
        raise LanguageError(
            f"the import of {path} leads out of the folder",
            hint="import files from the same folder",
        )
    wanted = "/".join(parts).lower()
    by_lower_name = {name.lower(): name for name in names}
    candidates = (wanted, *_ALIASES.get(wanted, ()))
    return next((by_lower_name[each] for each in candidates if each in by_lower_name), None)


def _import_problems(
    files: Mapping[str, GrammarFile], contents: Mapping[str, bytes]
) -> Iterator[Problem]:
    for file in files.values():
        for directive in file.imports:
            try:
                if resolve_import(directive.path, contents) is not None:
                    continue
            except LanguageError as error:
                yield error_at(directive.position, error.message, error.hint)
                continue
            yield error_at(
                directive.position,
                f"the imported file {directive.path} is missing",
                f"put it in the folder of {file.source}",
            )


def apply_alias(productions: Iterable[Production], alias: str) -> Iterator[Production]:
    """Yield the productions with ``$alias`` for ``$Main``, or unchanged if there is no alias."""
    for production in productions:
        yield rename(production, ROOT, alias) if alias else production


def _follow_imports(
    files: Mapping[str, GrammarFile], name: str, alias: str, taken: set[tuple[str, str]]
) -> Iterator[tuple[str, str]]:
    taken.add((name, alias))
    for directive in files[name].imports:
        target = _resolve(files, directive)
        inner = directive.alias or alias
        if target is not None and (target, inner) not in taken:
            yield from _follow_imports(files, target, inner, taken)
    if files[name].productions:
        yield name, alias


def _resolve(files: Mapping[str, GrammarFile], directive: Import) -> str | None:
    """Return the file that a directive means, or None if it is already reported as a problem."""
    try:
        return resolve_import(directive.path, files)
    except LanguageError:
        return None
