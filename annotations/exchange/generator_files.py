"""Read the files of a command generator into one value. Nothing is stored here."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from annotations.exchange.predicates_file import PREDICATES_FILE, read_predicates
from annotations.language.forms import DEFAULT_CLASSES, EntityClasses, read_form
from annotations.language.grammar import TRIPLE_FILES, is_grammar_name
from annotations.language.templates import (
    Generated,
    GeneratorFolder,
    TaskCategory,
    generate,
    is_template_name,
    read_generator_files,
    set_problems,
)
from annotations.language.texts import LanguageError, Position, Problem, read_text, warning_at
from annotations.language.world import (
    CLASSES_FILE,
    ENTITIES_FILE,
    ONTOLOGY_FILES,
    Ontology,
    Predicate,
    Signature,
    infer_signatures,
    read_ontology,
)
from annotations.models import World
from annotations.models.description import ProblemSubject
from annotations.rows.from_rows import classes_of
from annotations.rows.stored_problems import first_problems

# Above this many pairs signatures are inferred from the templates as they are, unexpanded.
INFERENCE_LIMIT = 100_000


@dataclass(frozen=True)
class Generator:
    """What the files of one generator say.

    ``problems`` are by the part of a world they are about, as many as ``first_problems`` lists.
    """

    texts: GeneratorFolder
    ontology: Ontology
    predicates: Mapping[str, Predicate]
    problems: Mapping[ProblemSubject, tuple[Problem, ...]]

    @property
    def all_problems(self) -> tuple[Problem, ...]:
        return tuple(problem for problems in self.problems.values() for problem in problems)


def read_generator(
    files: Mapping[str, bytes],
    edited: Mapping[str, Predicate] | None = None,
    known_problems: Iterable[Problem] = (),
    classes: EntityClasses = DEFAULT_CLASSES,
) -> Generator:
    """Read files given as name → bytes. Raises nothing: errors are among the problems.

    Args:
        edited: predicates that people have changed; they hold whatever the files say.
        known_problems: the problems that were found before the files were read.
        classes: those that the world has; the files may declare more.
    """
    ontology, ontology_problems = read_ontology(files, classes)
    texts = read_generator_files(files, ontology.classes)
    problems = [*known_problems, *texts.problems]
    known = {*ONTOLOGY_FILES, *TRIPLE_FILES, PREDICATES_FILE}
    for name in files:
        is_read = name.lower() in known or is_grammar_name(name) or is_template_name(name)
        if not is_read and not name.lower().startswith("readme"):
            hint = f"known are *.txt, {', '.join(ONTOLOGY_FILES)} and {PREDICATES_FILE}"
            problems.append(warning_at(Position(name), "not a generator file; ignored", hint))
    declared, further = _read_declared(files, ontology.classes)
    problems += further
    predicates = dict(declared or {})
    if not texts.has_errors:
        inferred, further = _examine(texts.categories(), declared, edited or {})
        predicates = predicates or {
            name: replace(each, signatures=_within(each.signatures, ontology.classes))
            for name, each in inferred.items()
        }
        problems += further
    distinct = set(problems)
    of_templates = {each for each in distinct if is_template_name(each.position.source)}
    by_subject = {
        ProblemSubject.ONTOLOGY: first_problems(set(ontology_problems)),
        ProblemSubject.GRAMMAR: first_problems(distinct - of_templates),
        ProblemSubject.TEMPLATES: first_problems(of_templates),
    }
    return Generator(texts, ontology, predicates, by_subject)


def classes_to_read(world: World | None, names: Iterable[str]) -> EntityClasses:
    """Return the classes that files of these names may use in ``world``, which an import then stores.

    A world by hand has its own alone, and so has a folder that declares its own. Those of GPSRCmdGen come with its
    files of entities, and to a world without any.
    """
    own = classes_of(world) if world else EntityClasses(())
    there = {name.lower() for name in names}
    of_household = {*ONTOLOGY_FILES} - {CLASSES_FILE, ENTITIES_FILE}
    if (own.rows or CLASSES_FILE in there) and of_household.isdisjoint(there):
        return own
    return DEFAULT_CLASSES.with_rows(own)


def _read_declared(
    files: Mapping[str, bytes], classes: EntityClasses
) -> tuple[dict[str, Predicate] | None, list[Problem]]:
    name = next((name for name in files if name.lower() == PREDICATES_FILE), None)
    if name is None:
        return None, []
    problems: list[Problem] = []
    try:
        predicates = read_predicates(files[name], name, problems, classes)
        problems += read_text(files[name], name)[1]
    except LanguageError as error:
        return None, [error.problem]
    return predicates, problems


def _within(signatures: Iterable[Signature], classes: EntityClasses) -> tuple[Signature, ...]:
    """Return the signatures with texts for class tokens of no class, which a form may write out."""
    return tuple(sorted({each.within(classes) for each in signatures}))


def _examine(
    categories: tuple[TaskCategory, ...],
    declared: Mapping[str, Predicate] | None,
    edited: Mapping[str, Predicate],
) -> tuple[dict[str, Predicate], list[Problem]]:
    """Return the predicates that the forms use, and what the templates' commands and forms show wrong."""
    try:
        generated = generate(categories, INFERENCE_LIMIT)
        forms = [read_form(text) for text in {each.form_text for each in generated.expansions}]
        by_name = {category.name: category.templates for category in categories}
        left_out = generated.left_out
        forms += [by_name[each.task_category][each.template_index].form for each in left_out]
    except LanguageError:
        # Too many, or a template with an error that set_problems finds at its place.
        generated = Generated((), (), ())
        forms = [template.form for category in categories for template in category.templates]
    inferred = infer_signatures(forms)
    known = {**(inferred if declared is None else declared), **edited}
    return inferred, list(set_problems(categories, generated, known))
