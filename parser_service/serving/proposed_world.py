"""The answerer of a world together with what lines propose, before anything of it is stored."""

from __future__ import annotations

from threading import Lock

from annotations.language.forms import Form, Symbols
from annotations.language.grounding import Anonymizer
from annotations.language.induction import categories_with, propose, with_proposal
from annotations.language.plans import Lookup, StoppingWords, usual_places
from annotations.models import World
from annotations.rows.from_rows import ontology_of, recipe_book_of, task_categories
from annotations.rows.known_world import known_world_of
from parser_service.parsers.interface import Knowledge
from parser_service.parsers.oracle import GrammarOracle
from parser_service.serving.action_naming import names_of
from parser_service.serving.answer_writing import AnswerWriter
from parser_service.serving.answerer import Answerer, LoadedParser
from parser_service.serving.batching import Batcher
from parser_service.serving.preparing import LearnedUse, WorldLanguage, derive, learned_use


def answerer_with(world: World, text: str) -> Answerer | None:
    """Return what answers in ``world`` once the lines of ``text`` are stored, by the oracle alone; None while neither
    has a template.

    Raises LanguageError where a stored text cannot be read.
    """
    known = known_world_of(world)
    proposal = propose(text, known)
    changed = {each.name: each for each in categories_with(proposal, known)}
    stored = {each.name: each for each in task_categories(world)}
    categories = tuple((stored | changed).values())
    if not any(each.templates for each in categories):
        return None
    ontology = with_proposal(ontology_of(world), proposal, known)
    proposed = {each.predicate.name: each.predicate for each in proposal.predicates}
    predicates = {**known.predicates, **proposed}
    oracle = GrammarOracle(knowledge=Knowledge(predicates, ontology, categories))
    lookup = Lookup(ontology, predicates)

    def derivations() -> tuple[tuple[Symbols, Form], ...]:
        return (*learned_use(world).derivations, *derive(changed.values()))

    language = WorldLanguage(
        ontology,
        predicates,
        Anonymizer(ontology),
        lookup,
        names_of(world),
        recipe_book_of(world),
        usual_places(ontology, lookup),
        LearnedUse(derivations, predicates, ontology.classes),
    )
    part = LoadedParser(
        run=None,
        name=oracle.name,
        score_kind=str(oracle.score_kind or ""),
        knowledge=(),
        size=0,
        batcher=Batcher(oracle.predict, Lock()),
        parser=oracle,
    )
    stopping = StoppingWords(ontology, oracle.vocabulary)
    return Answerer(world.name, AnswerWriter(language), oracle.reader, stopping, oracle=part)
