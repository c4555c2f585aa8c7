"""A folder of grammar files: which files are grammars, and what each one imports."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import PurePosixPath

from annotations.language.forms import (
    DEFAULT_CLASSES,
    Choice,
    EntityClasses,
    Nonterminal,
    Symbol,
    Symbols,
    Wildcard,
)
from annotations.language.grammar.grammar import ROOT, Grammar
from annotations.language.grammar.productions import (
    GrammarFile,
    Production,
    read_productions,
)
from annotations.language.texts import (
    EmptyFile,
    LanguageError,
    Position,
    Problem,
    Severity,
    decode,
    error_at,
    read_text,
    warning_at,
)

TEMPLATE_SUFFIX = "_semantics.txt"
# Text files of a generator folder that belong to the ontology (docs/reference/formats.md, Ontology files).
_ONTOLOGY_TEXTS = frozenset({"categories.txt", "whattosay.txt"})
# Grounded triples (docs/reference/formats.md, Triples) that may be in the same folder.
TRIPLE_FILES = frozenset({"paraphrases.txt", "paraphrasings.txt"})
# Slot-filling rules, which some folders have beside their templates. They are no productions.
SLOT_SUFFIX = "_slot.txt"
MOST_ALIASES = 20  # of a folder: each file may be taken once for each of them
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
        return tuple(_follow_imports(self.files, name, set()))


def read_grammar_files(
    contents: Mapping[str, bytes], classes: EntityClasses = DEFAULT_CLASSES
) -> GrammarFolder:
    """Read the grammar files among ``contents`` (file name → bytes). Wildcards may be of ``classes``.

    Every ``*.txt`` may be a grammar file except templates, slot-filling rules, a README, the two text
    files of the ontology and triples. One that holds comments or prose only is left out with a warning,
    and so is one that has faults and that no grammar uses. These are errors where nothing else is a
    grammar, or where templates go with the file.
    """
    files: dict[str, GrammarFile] = {}
    problems: list[Problem] = []
    unread: list[Problem] = []
    for name in sorted(filter(is_grammar_name, contents)):
        try:
            text, changes = read_text(contents[name], name)
            file = read_productions(text, name, classes)
        except EmptyFile as error:
            unread.append(error.problem)
        except LanguageError as error:
            problems.append(error.problem)
        else:
            if file.is_prose:
                unread.extend(file.problems)
            else:
                files[name] = replace(file, problems=(*changes, *file.problems))
    problems += _bound_aliases(files)
    names = {name.lower() for name in contents}
    for name in _unused(files, names):
        of_file = [*files[name].problems, *_import_problems(files[name], contents)]
        if errors := [problem for problem in of_file if problem.is_error]:
            first = min(errors)
            rest = f" (and {len(errors) - 1:,} more)" if len(errors) > 1 else ""
            unread.append(
                warning_at(
                    first.position,
                    f"no grammar uses this file, and it is left out: {first.message}{rest}",
                    "import it from a grammar, or remove it",
                )
            )
            del files[name]
    for file in files.values():
        problems += [*file.problems, *_import_problems(file, contents)]
    is_missing = not files and not problems
    for problem in unread:
        is_error = is_missing or _templates_of(problem.position.source) in names
        severity = Severity.ERROR if is_error else Severity.WARNING
        problems.append(replace(problem, severity=severity))
    if is_missing and not unread:
        problems.append(
            error_at(Position(), "there is no grammar here", "add a file like gpsr.txt")
        )
    return GrammarFolder(files, tuple(problems))


def _bound_aliases(files: dict[str, GrammarFile]) -> list[Problem]:
    """Drop the imports beyond ``MOST_ALIASES`` aliases, and return an error at the first of them."""
    named = [each for file in files.values() for each in file.imports if each.alias]
    known = set(list(dict.fromkeys(each.alias for each in named))[:MOST_ALIASES])
    superfluous = next((each for each in named if each.alias not in known), None)
    if superfluous is None:
        return []
    for name, file in files.items():
        kept = tuple(each for each in file.imports if each.alias in known or not each.alias)
        files[name] = replace(file, imports=kept)
    sentence = f"the files have more than {MOST_ALIASES} aliases in their imports"
    return [error_at(superfluous.position, sentence, "import the file under fewer names")]


def _templates_of(name: str) -> str:
    """Return the name, in lower case, of the templates that go with a grammar file."""
    stem = name.lower().removesuffix(".txt").removesuffix("_grammar")
    return stem + TEMPLATE_SUFFIX


def _unused(files: Mapping[str, GrammarFile], names: Container[str]) -> list[str]:
    """Return the files that belong to no grammar, if there is one: without a root, and imported by none.

    A root that has faults is one all the same, and so is a file that templates go with.

    Args:
        names: of all files, in lower case.
    """
    roots = [
        name for name, file in files.items() if file.means(ROOT) or _templates_of(name) in names
    ]
    taken: set[tuple[str, str]] = set()
    for name in roots:
        tuple(_follow_imports(files, name, taken))
    used = {name for name, _ in taken}
    return [name for name in files if roots and name not in used]


def is_grammar_name(name: str) -> bool:
    """Return whether a file with this name in a generator folder is a grammar."""
    lower = name.lower()
    return (
        lower.endswith(".txt")
        and not lower.endswith((TEMPLATE_SUFFIX, SLOT_SUFFIX))
        and not lower.startswith("readme")
        and "/" not in name
        and lower not in _ONTOLOGY_TEXTS | TRIPLE_FILES
    )


def is_prose(data: bytes, name: str) -> bool:
    """Return whether a file has the name of a grammar but holds only comments, prose or nothing."""
    if not is_grammar_name(name.rsplit("/", 1)[-1]):
        return False
    try:
        return read_productions(decode(data, name), name).is_prose
    except LanguageError as error:
        return isinstance(error, EmptyFile)


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


def _import_problems(file: GrammarFile, contents: Mapping[str, bytes]) -> Iterator[Problem]:
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
    files: Mapping[str, GrammarFile], name: str, taken: set[tuple[str, str]]
) -> Iterator[tuple[str, str]]:
    """Yield the files with productions that ``name`` is made of, each with its alias: imports come first.

    What is ``taken`` is not followed again. Imports may lead through more files and aliases than calls nest.
    """
    targets: dict[str, list[tuple[str, str]]] = {}
    taken.add((name, ""))
    path = [(name, "", 0)]  # the files that are open, and how many imports of each were followed
    while path:
        source, alias, number = path.pop()
        if source not in targets:
            resolved: dict[tuple[str, str], None] = {}
            for each in files[source].imports:
                with suppress(LanguageError):  # which is reported as a problem of the import
                    if target := resolve_import(each.path, files):
                        resolved[target, each.alias] = None
            targets[source] = list(resolved)
        if number == len(targets[source]):
            if files[source].productions:
                yield source, alias
            continue
        path.append((source, alias, number + 1))
        target, own_alias = targets[source][number]
        following = target, own_alias or alias
        if following not in taken:
            taken.add(following)
            path.append((*following, 0))


def rename(production: Production, old: str, new: str) -> Production:
    """Return the production with ``$new`` for ``$old`` on both sides and in notes."""
    return Production(
        new if production.nonterminal == old else production.nonterminal,
        _rename(production.expansion, old, new),
        production.position,
        tuple((new if name == old else name, position) for name, position in production.references),
    )


def _rename(sequence: Symbols, old: str, new: str) -> Symbols:
    renamed: list[Symbol] = []
    for symbol in sequence:
        match symbol:
            case Nonterminal(name) if name == old:
                renamed.append(Nonterminal(new))
            case Choice(alternatives):
                renamed.append(Choice(tuple(_rename(each, old, new) for each in alternatives)))
            case Wildcard(meta=meta) if meta:
                renamed.append(replace(symbol, meta=_rename(meta, old, new)))
            case _:
                renamed.append(symbol)
    return tuple(renamed)
