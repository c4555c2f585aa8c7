"""A folder of grammar files: which files are grammars, and what each one imports."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from annotations.language.comments import Import
from annotations.language.decoding import decode, read_folder
from annotations.language.errors import LanguageError, Position, Problem, error
from annotations.language.grammar import ROOT, Grammar
from annotations.language.productions import GrammarFile, Production, read_productions
from annotations.language.renaming import renamed_production

TEMPLATE_SUFFIX = "_semantics.txt"
# Text files of a generator folder that belong to the ontology (FORMATS §2).
ONTOLOGY_FILES = frozenset({"categories.txt", "whattosay.txt"})
# Grounded triples (FORMATS §6) that may lie beside the grammar.
TRIPLE_FILES = frozenset({"paraphrases.txt", "paraphrasings.txt"})
# GPSRCmdGen's files import the first name while the file beside them bears another.
_ALIASES = {"common.txt": ("common_rules.txt", "commonrules.txt")}


@dataclass(frozen=True, slots=True)
class GrammarFolder:
    """The grammar files of a folder by name, and every problem of reading them.

    Problems of a grammar as a whole (``Grammar.problems``) are not among them.
    """

    files: Mapping[str, GrammarFile]
    problems: tuple[Problem, ...]

    def grammar(self, name: str) -> Grammar:
        """The productions of the file ``name`` behind those it imports, each file taken once."""
        return Grammar(tuple(_with_imports(self.files, name, "", set())))

    def roots(self) -> tuple[str, ...]:
        """The names of the files that define ``$Main``, sorted."""
        return tuple(sorted(name for name, file in self.files.items() if file.defines(ROOT)))


def read_grammar_folder(folder: Path) -> GrammarFolder:
    """Reads every grammar file of ``folder`` itself (not of folders inside it).

    Raises:
        LanguageError: the folder cannot be read, or holds more than it may.
    """
    return read_grammar_files(read_folder(folder, "*.txt"))


def read_grammar_files(contents: Mapping[str, bytes]) -> GrammarFolder:
    """Reads the grammar files among ``contents`` (file name → bytes).

    Grammar files are all ``*.txt`` but templates, the two text files of the ontology and triples.
    """
    files: dict[str, GrammarFile] = {}
    problems: list[Problem] = []
    for name in sorted(filter(is_grammar_name, contents)):
        try:
            files[name] = read_productions(decode(contents[name], name), name)
            problems.extend(files[name].problems)
        except LanguageError as trouble:
            problems.append(trouble.problem)
    if not files and not problems:
        problems.append(error(Position(), "there is no grammar here", "add a file like gpsr.txt"))
    problems.extend(_import_problems(files, contents))
    return GrammarFolder(files, tuple(problems))


def is_grammar_name(name: str) -> bool:
    """Whether a file of this name in a generator folder is a grammar."""
    lower = name.lower()
    return (
        lower.endswith(".txt")
        and not lower.endswith(TEMPLATE_SUFFIX)
        and lower not in ONTOLOGY_FILES | TRIPLE_FILES
    )


def resolve_import(path: str, names: Mapping[str, object]) -> str | None:
    """The file that an import means: the same name in any case, or what ``common.txt`` stands for.

    Returns:
        A key of ``names``, or None where there is no such file.

    Raises:
        LanguageError: (without position) the path leaves the folder.
    """
    parts = PurePosixPath(path.replace("\\", "/")).parts
    if not parts or parts[0] == "/" or ".." in parts or ":" in path:
        raise LanguageError(
            f"the import of {path} leaves the folder", hint="import files that lie beside this one"
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
            except LanguageError as trouble:
                yield error(directive.position, trouble.message, trouble.hint)
                continue
            yield error(
                directive.position,
                f"the imported file {directive.path} is not here",
                f"put it beside {file.source}",
            )


def _with_imports(
    files: Mapping[str, GrammarFile], name: str, alias: str, taken: set[tuple[str, str]]
) -> Iterator[Production]:
    """The file's productions behind its imports'; ``$Main`` is ``$alias`` where one is given.

    An alias holds for the whole of what is imported, until an import further down gives another.
    """
    taken.add((name, alias))
    for directive in files[name].imports:
        target = _imported(files, directive)
        inner = directive.alias or alias
        if target is not None and (target, inner) not in taken:
            yield from _with_imports(files, target, inner, taken)
    for production in files[name].productions:
        yield renamed_production(production, ROOT, alias) if alias else production


def _imported(files: Mapping[str, GrammarFile], directive: Import) -> str | None:
    """The file a directive means, None where it was already reported as a problem."""
    try:
        return resolve_import(directive.path, files)
    except LanguageError:
        return None
