"""A folder of a command generator: its grammars, its templates and the task categories they make."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from annotations.language.decoding import decode, read_folder
from annotations.language.errors import LanguageError, Position, Problem, error, warning
from annotations.language.expansion import TaskCategory
from annotations.language.grammar_files import GrammarFolder, read_grammar_files
from annotations.language.task_categories import Composition, compose, is_template_name
from annotations.language.templates import SemanticTemplate, read_templates


@dataclass(frozen=True, slots=True)
class GeneratorFolder:
    """What the text files of a generator folder hold; its ontology is read elsewhere.

    ``problems`` are those of reading and of the grammars. Those of templates against grammars come
    from ``template_sets.set_problems`` once there is no error here.
    """

    grammars: GrammarFolder
    templates: Mapping[str, tuple[SemanticTemplate, ...]]
    compositions: tuple[Composition, ...]
    problems: tuple[Problem, ...]

    @property
    def has_errors(self) -> bool:
        return any(problem.is_error for problem in self.problems)

    def categories(self) -> tuple[TaskCategory, ...]:
        """The task categories in order, each with the templates of its set."""
        return tuple(self._category(composition) for composition in self.compositions)

    def _category(self, composition: Composition) -> TaskCategory:
        found = (self.templates.get(name, ()) for name in composition.template_files)
        grammar = self.grammars.grammar(composition.grammar_file)
        return TaskCategory(composition.name, grammar, tuple(t for file in found for t in file))


def read_generator_folder(folder: Path) -> GeneratorFolder:
    """Reads the ``*.txt`` files of ``folder``.

    Raises:
        LanguageError: the folder cannot be read, or holds more than it may.
    """
    return read_generator_files(read_folder(folder, "*.txt"))


def read_generator_files(contents: Mapping[str, bytes]) -> GeneratorFolder:
    """Reads grammars and templates among files given as name → bytes. Nothing is raised."""
    grammars = read_grammar_files(contents)
    templates, problems = _read_templates(contents)
    compositions = compose(grammars.files, contents)
    found = [
        *grammars.problems,
        *problems,
        *_lonely_templates(templates, compositions),
        *_grammar_problems(grammars, compositions),
    ]
    if grammars.files and not compositions and not any(problem.is_error for problem in found):
        found.append(error(Position(min(grammars.files)), "no grammar here defines $Main"))
    return GeneratorFolder(grammars, templates, compositions, tuple(sorted(found)))


def _read_templates(
    contents: Mapping[str, bytes],
) -> tuple[dict[str, tuple[SemanticTemplate, ...]], list[Problem]]:
    templates: dict[str, tuple[SemanticTemplate, ...]] = {}
    problems: list[Problem] = []
    for name in sorted(filter(is_template_name, contents)):
        try:
            templates[name], found = read_templates(decode(contents[name], name), name)
            problems.extend(found)
        except LanguageError as trouble:
            problems.append(trouble.problem)
    return templates, problems


def _lonely_templates(
    templates: Mapping[str, object], compositions: tuple[Composition, ...]
) -> Iterator[Problem]:
    used = {name for composition in compositions for name in composition.template_files}
    for name in templates.keys() - used:
        yield warning(
            Position(name),
            "no grammar goes with these templates",
            "X_semantics.txt goes with X_grammar.txt or X.txt, if that defines $Main",
        )


def _grammar_problems(
    grammars: GrammarFolder, compositions: tuple[Composition, ...]
) -> Iterator[Problem]:
    """The problems of each grammar; of a shared file only what every grammar with it complains of.

    (A rule of the common file that one task category never reaches may well serve another.)
    """
    found: dict[Problem, int] = {}
    holders: dict[Position, int] = {}
    for composition in compositions:
        grammar = grammars.grammar(composition.grammar_file)
        for problem in grammar.problems():
            found[problem] = found.get(problem, 0) + 1
        for position in {production.position for production in grammar.productions}:
            holders[position] = holders.get(position, 0) + 1
    for problem, count in found.items():
        if count >= holders.get(problem.position, 0) or problem.is_error:
            yield problem
