"""Answer an utterance with a trained parser. Loads torch where the parser needs it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

from annotations.language.errors import LanguageError
from annotations.language.forms import CLASS_TOKEN, Form, read_form, to_corpus, to_reading
from annotations.language.grounding import Anonymized, Anonymizer, Deanonymized, deanonymize
from annotations.language.ontology import Ontology
from annotations.language.predicates import Predicate, gloss
from annotations.language.symbols import ENTITY_CLASSES
from annotations.models import World
from annotations.models.background import Status
from annotations.rows.from_rows import ontology_of, predicates_of
from parser_service.models import Evaluation, TrainingRun
from parser_service.parsers.conditions import TrainSources
from parser_service.parsers.interface import Candidate, Parser
from parser_service.parsers.registry import load_class
from parser_service.runs.checkpoints import model_folder
from parser_service.runs.knowledge import knowledge_of

LOADED_PARSERS = 2
# What a person says is what counts; of runs that were never tested on it, the next best.
EVIDENCE = ("para", "mixed", "gen")


@dataclass(frozen=True, slots=True)
class Answer:
    """One candidate. ``grounded`` names the entities of the utterance where that is certain, and
    ``remarks`` say why where it is not; the texts but ``form`` and ``score`` are empty where the
    parser wrote no well-formed form."""

    form: str
    score: float
    is_well_formed: bool = False
    grounded: str = ""
    reading: str = ""
    gloss: str = ""
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Parse:
    """The answers to an utterance. ``parsed_text`` is what the parser was given; ``remarks`` say what
    of it the world does not know."""

    utterance: str
    parsed_text: str
    answers: tuple[Answer, ...]
    remarks: tuple[str, ...] = ()


def best_run(world: World) -> TrainingRun:
    """Return the succeeded run of ``world`` that is most often right on validation paraphrases.

    Runs on a share of the training pairs do not count. Of equally good ones the newest; where nothing
    was tested on paraphrases, generated commands decide. Raises ValueError, a sentence, where no run has
    succeeded.
    """
    tested = Evaluation.objects.filter(
        run__world=world, run__status=Status.SUCCEEDED, run__train_share=1, part="validation"
    )
    for source in EVIDENCE:
        best = tested.filter(test_source=source).order_by("-accuracy", "-run_id").first()
        if best:
            return best.run
    raise ValueError(f"No run of {world} has succeeded yet. Train a parser, then ask again.")


def parse(run: TrainingRun, utterance: str, beam_width: int = 5) -> Parse:
    """Return the answers of ``run`` to ``utterance``, best first. Raises ValueError where it cannot answer."""
    parser = load_parser(run)
    ontology, predicates = ontology_of(run.world), predicates_of(run.world)
    anonymized = Anonymizer(ontology).anonymize(utterance)
    text = text_for(run, anonymized)
    candidates = parser.predict([text], beam_width)[0]
    answers = (_answer(each, anonymized, ontology, predicates) for each in candidates)
    return Parse(utterance, text, tuple(answers), tuple(_unknown_tokens(utterance, ontology)))


def text_for(run: TrainingRun, anonymized: Anonymized) -> str:
    """Return what the parser of ``run`` is given for an utterance that somebody typed.

    One that was trained on generated commands alone has only ever seen class tokens, so it gets them in
    place of the entities.
    """
    is_anonymous = run.train_sources == TrainSources.GENERATED
    return anonymized.command if is_anonymous else anonymized.original


def load_parser(run: TrainingRun) -> Parser:
    """Load the saved parser of a succeeded run; the last few stay loaded. Raises ValueError."""
    if run.status != Status.SUCCEEDED:
        raise ValueError(f"Run {run.pk} is {run.status}, so there is no parser to ask.")
    return _load(run.pk)


@lru_cache(maxsize=LOADED_PARSERS)
def _load(run_id: int) -> Parser:
    run = TrainingRun.objects.select_related("world").get(pk=run_id)
    folder = model_folder(run_id)
    if not folder.is_dir():
        raise ValueError(
            f"The parser of run {run_id} is not in {folder}. Bring that folder back, or train again."
        )
    return load_class(run.parser).load(folder, knowledge_of(run.world, run.protocol))


def _answer(
    candidate: Candidate,
    anonymized: Anonymized,
    ontology: Ontology,
    predicates: Mapping[str, Predicate],
) -> Answer:
    try:
        form: Form = read_form(candidate.form)
    except LanguageError:
        return Answer(candidate.form, candidate.score)
    deanonymized = deanonymize(form, anonymized, ontology)
    grounded = deanonymized.form
    return Answer(
        form=candidate.form,
        score=candidate.score,
        is_well_formed=True,
        grounded=to_corpus(grounded),
        reading=to_reading(grounded),
        gloss=gloss(grounded, predicates),
        remarks=tuple(dict.fromkeys(_open_slots(deanonymized, ontology))),
    )


def _unknown_tokens(utterance: str, ontology: Ontology) -> Iterator[str]:
    """Yield a sentence for each class token of ``utterance`` that stands for nothing in the world."""
    for token in dict.fromkeys(CLASS_TOKEN.findall(utterance)):
        entity_class = token.rstrip("0123456789")
        if entity_class not in ENTITY_CLASSES:
            known = ", ".join(f"<{name}>" for name in ENTITY_CLASSES)
            yield f"<{token}> is not a class of entities. There are: {known}."
        elif not ontology.of_class(entity_class):
            yield f"<{token}>: this world has no entity of the class {entity_class}."


def _open_slots(deanonymized: Deanonymized, ontology: Ontology) -> Iterator[str]:
    """Yield a sentence for each slot of an answer that no entity fills with certainty."""
    for slot in deanonymized.open_slots:
        if slot.is_ambiguous:
            yield f"{slot.token} stays open: it may be {' or '.join(slot.candidates)}."
        elif slot.entity_class and not ontology.of_class(slot.entity_class):
            yield f"{slot.token} stays open: this world has no entity of the class {slot.entity_class}."
        elif slot.entity_class:
            yield f"{slot.token} stays open: the utterance names no {slot.entity_class} of this world."
