"""A folder of a command generator: its grammars, its templates and the task categories they make."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path

from annotations.language.forms import DEFAULT_CLASSES, EntityClasses
from annotations.language.grammar import (
    ROOT,
    TEMPLATE_SUFFIX,
    GrammarFile,
    GrammarFolder,
    read_grammar_files,
)
from annotations.language.templates.expansion import TaskCategory
from annotations.language.templates.templates import SemanticTemplate, read_templates
from annotations.language.texts import (
    MAX_TASK_CATEGORY,
    EmptyFile,
    LanguageError,
    Position,
    Problem,
    Severity,
    error_at,
    read_folder,
    read_text,
    require_name,
    warning_at,
)

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
    its stem (without ``_grammar``). ``X_grammar.txt`` and ``X.txt`` go with ``X_semantics.txt``. The templates
    of files that are imported come before those of the file itself.
    """
    templates = {name.lower(): name for name in file_names if is_template_name(name)}
    roots = sorted(name for name, file in grammar_files.items() if file.defines(ROOT))
    bases = {name: _base(name) for name in roots}
    matches = {name: _NUMBERED.fullmatch(base) for name, base in bases.items()}
    claims = Counter(match["number"] for match in matches.values() if match)
    compositions: list[Composition] = []
    folder = GrammarFolder(grammar_files, ())
    for file, base in bases.items():
        match = matches[file]
        inherited = _INHERITED.get(match["number"], ()) if match else ()
        *imported, _ = (_base(source) for source, _ in folder.sources(file))
        earlier = (re.sub(r"(?<!\d)\d+$", number, base) for number in inherited)
        wanted = (f"{each}{TEMPLATE_SUFFIX}".lower() for each in (*imported, *earlier, base))
        own = tuple(dict.fromkeys(templates[name] for name in wanted if name in templates))
        name = match["number"] if match and claims[match["number"]] == 1 else base
        compositions.append(Composition(name, file, own))
    numbered = [each for each in compositions if each.name.isdecimal()]
    named = [each for each in compositions if not each.name.isdecimal()]
    numbered.sort(key=lambda each: (int(each.name), each.name))
    return (*numbered, *sorted(named, key=lambda each: each.name))


def is_template_name(name: str) -> bool:
    """Return whether a file of this name holds semantic templates."""
    return name.lower().endswith(TEMPLATE_SUFFIX)


def _base(file_name: str) -> str:
    stem = file_name.rsplit(".", 1)[0]
    return re.sub("_grammar$", "", stem, flags=re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class GeneratorFolder:
    """The content of the text files of a generator folder; its ontology is read elsewhere.

    ``problems`` come from reading and from the grammars. If there are no errors,
    ``set_problems`` checks the templates against the grammars.
    """

    grammars: GrammarFolder
    templates: Mapping[str, tuple[SemanticTemplate, ...]]
    compositions: tuple[Composition, ...]
    problems: tuple[Problem, ...]

    @property
    def has_errors(self) -> bool:
        return any(problem.is_error for problem in self.problems)

    def categories(self) -> tuple[TaskCategory, ...]:
        """Return the task categories in order, each with the templates of its set."""
        categories: list[TaskCategory] = []
        for composition in self.compositions:
            sets = (self.templates.get(name, ()) for name in composition.template_files)
            templates = tuple(chain.from_iterable(sets))
            grammar = self.grammars.grammar(composition.grammar_file)
            categories.append(TaskCategory(composition.name, grammar, templates))
        return tuple(categories)


def read_generator_folder(folder: Path) -> GeneratorFolder:
    """Read the ``*.txt`` files of ``folder``.

    Raises:
        LanguageError: the folder cannot be read, or holds too much.
    """
    return read_generator_files(read_folder(folder, "*.txt"))


def read_generator_files(
    contents: Mapping[str, bytes], classes: EntityClasses = DEFAULT_CLASSES
) -> GeneratorFolder:
    """Read the grammars and templates among files given as name → bytes. Errors are returned, not raised.

    Wildcards may be of ``classes``.
    """
    grammars = read_grammar_files(contents, classes)
    templates: dict[str, tuple[SemanticTemplate, ...]] = {}
    problems: list[Problem] = []
    for name in sorted(filter(is_template_name, contents)):
        try:
            text, changes = read_text(contents[name], name)
            templates[name], unread = read_templates(text, name, classes)
            problems.extend((*changes, *unread))
        except EmptyFile as error:
            problems.append(replace(error.problem, severity=Severity.WARNING))
        except LanguageError as error:
            problems.append(error.problem)
    compositions = compose(grammars.files, contents)
    used = {name for composition in compositions for name in composition.template_files}
    all_problems = [
        *grammars.problems,
        *problems,
        *(
            warning_at(
                Position(name),
                "no grammar goes with these templates",
                "X_semantics.txt goes with X_grammar.txt or X.txt, if that defines $Main",
            )
            for name in templates.keys() - used
        ),
        *_bad_names(compositions),
        *_grammar_problems(grammars, compositions),
    ]
    if (
        grammars.files
        and not compositions
        and not any(problem.is_error for problem in all_problems)
    ):
        all_problems.append(
            error_at(Position(min(grammars.files)), "no grammar here defines $Main")
        )
    return GeneratorFolder(grammars, templates, compositions, tuple(sorted(all_problems)))


def _bad_names(compositions: tuple[Composition, ...]) -> Iterator[Problem]:
    """Yield errors for task category names that are too long, or that two files have."""
    files: dict[str, str] = {}
    for composition in compositions:
        first = files.setdefault(composition.name, composition.grammar_file)
        if first != composition.grammar_file:
            yield error_at(
                Position(composition.grammar_file),
                f"the task category {composition.name} already comes from {first}",
                "rename or remove one of the two files",
            )
        try:
            place = Position(composition.grammar_file)
            require_name(composition.name, "task category", MAX_TASK_CATEGORY, place)
        except LanguageError as error:
            yield error_at(error.position, error.message, f"{error.hint} for the file")


def _grammar_problems(
    grammars: GrammarFolder, compositions: tuple[Composition, ...]
) -> Iterator[Problem]:
    """Yield the problems of each grammar; for a shared file, only those that all its grammars have.

    (A rule of the common file that one task category never reaches may be used by another.)
    """
    counts: dict[Problem, int] = {}
    holders: dict[Position, int] = {}
    for composition in compositions:
        grammar = grammars.grammar(composition.grammar_file)
        for problem in grammar.problems():
            counts[problem] = counts.get(problem, 0) + 1
        for position in {production.position for production in grammar.productions}:
            holders[position] = holders.get(position, 0) + 1
    for problem, count in counts.items():
        if count >= holders.get(problem.position, 0) or problem.is_error:
            yield problem
