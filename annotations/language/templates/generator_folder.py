"""A folder of a command generator: its grammars, its templates and the task categories they make."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from annotations.language.decoding import decode, read_folder
from annotations.language.errors import LanguageError, Position, Problem, error_at, warning_at
from annotations.language.grammar import GrammarFolder, read_grammar_files
from annotations.language.limits import MAX_TASK_CATEGORY, require_name
from annotations.language.templates.expansion import TaskCategory
from annotations.language.templates.task_categories import Composition, compose, is_template_name
from annotations.language.templates.templates import SemanticTemplate, read_templates


@dataclass(frozen=True, slots=True)
class GeneratorFolder:
    """The content of the text files of a generator folder; its ontology is read elsewhere.

    ``problems`` come from reading and from the grammars. If there are no errors,
    ``sets.set_problems`` checks the templates against the grammars.
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
        return tuple(self._category(composition) for composition in self.compositions)

    def _category(self, composition: Composition) -> TaskCategory:
        sets = (self.templates.get(name, ()) for name in composition.template_files)
        grammar = self.grammars.grammar(composition.grammar_file)
        return TaskCategory(composition.name, grammar, tuple(t for file in sets for t in file))


def read_generator_folder(folder: Path) -> GeneratorFolder:
    """Read the ``*.txt`` files of ``folder``.

    Raises:
        LanguageError: the folder cannot be read, or holds too much.
    """
    return read_generator_files(read_folder(folder, "*.txt"))


def read_generator_files(contents: Mapping[str, bytes]) -> GeneratorFolder:
    """Read the grammars and templates among files given as name → bytes. Errors are returned, not raised."""
    grammars = read_grammar_files(contents)
    templates, problems = _read_templates(contents)
    compositions = compose(grammars.files, contents)
    all_problems = [
        *grammars.problems,
        *problems,
        *_lonely_templates(templates, compositions),
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


def _read_templates(
    contents: Mapping[str, bytes],
) -> tuple[dict[str, tuple[SemanticTemplate, ...]], list[Problem]]:
    templates: dict[str, tuple[SemanticTemplate, ...]] = {}
    problems: list[Problem] = []
    for name in sorted(filter(is_template_name, contents)):
        try:
            templates[name], unread = read_templates(decode(contents[name], name), name)
            problems.extend(unread)
        except LanguageError as error:
            problems.append(error.problem)
    return templates, problems


def _lonely_templates(
    templates: Mapping[str, object], compositions: tuple[Composition, ...]
) -> Iterator[Problem]:
    used = {name for composition in compositions for name in composition.template_files}
    for name in templates.keys() - used:
        yield warning_at(
            Position(name),
            "no grammar goes with these templates",
            "X_semantics.txt goes with X_grammar.txt or X.txt, if that defines $Main",
        )


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
