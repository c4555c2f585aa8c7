"""Answers an utterance with a trained parser. Loads torch where the parser needs it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from annotations.language.anonymizer import Anonymized, Anonymizer
from annotations.language.deanonymizer import deanonymize
from annotations.language.errors import LanguageError
from annotations.language.logic import Form, read_form, to_corpus, to_reading
from annotations.language.ontology import Ontology
from annotations.language.predicates import Predicate, gloss
from annotations.models import World
from annotations.reading import ontology_of, predicates_of
from parser_service.checkpoints import model_folder
from parser_service.knowledge import knowledge_of
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.runs import Status, TrainSources
from parser_service.parsers.interface import Candidate, Parser
from parser_service.parsers.registry import load_class

LOADED_PARSERS = 2
# What a person says is what counts; of runs that were never tested on it, the next best.
EVIDENCE = ("para", "mixed", "gen")


@dataclass(frozen=True, slots=True)
class Answer:
    """One candidate. ``grounded`` names the entities of the utterance where that is certain; the
    texts but ``form`` and ``score`` are empty where the parser wrote no well-formed form."""

    form: str
    score: float
    is_well_formed: bool = False
    grounded: str = ""
    reading: str = ""
    gloss: str = ""


@dataclass(frozen=True, slots=True)
class Parse:
    """What became of an utterance. ``parsed_text`` is what the parser was given."""

    utterance: str
    parsed_text: str
    answers: tuple[Answer, ...]


def best_run(world: World) -> TrainingRun:
    """The succeeded run of ``world`` that is most often right on validation paraphrases.

    Of equally good ones the newest; where nothing was tested on paraphrases, generated commands
    decide. Raises ValueError, a sentence, where no run has succeeded.
    """
    tested = Evaluation.objects.filter(
        run__world=world, run__status=Status.SUCCEEDED, part="validation"
    )
    for source in EVIDENCE:
        best = tested.filter(test_source=source).order_by("-accuracy", "-run_id").first()
        if best:
            return best.run
    raise ValueError(f"No run of {world} has succeeded yet. Train a parser, then ask again.")


def parse(run: TrainingRun, utterance: str, beam_width: int = 5) -> Parse:
    """The answers of ``run`` to ``utterance``, best first. Raises ValueError where it cannot answer.

    A parser that was trained on generated commands alone has only ever seen class tokens, so it is
    given the utterance with its entities replaced.
    """
    parser = load_parser(run)
    ontology, predicates = ontology_of(run.world), predicates_of(run.world)
    anonymized = Anonymizer(ontology).anonymize(utterance)
    is_anonymous = run.train_sources == TrainSources.GENERATED
    text = anonymized.command if is_anonymous else utterance
    found: Sequence[Candidate] = parser.predict([text], beam_width)[0]
    answers = (_answer(each, anonymized, ontology, predicates) for each in found)
    return Parse(utterance, text, tuple(answers))


def load_parser(run: TrainingRun) -> Parser:
    """The saved parser of a succeeded run; the last few stay loaded. Raises ValueError."""
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
    grounded = deanonymize(form, anonymized, ontology).form
    return Answer(
        form=candidate.form,
        score=candidate.score,
        is_well_formed=True,
        grounded=to_corpus(grounded),
        reading=to_reading(grounded),
        gloss=gloss(grounded, predicates),
    )
