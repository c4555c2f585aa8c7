"""Answers that are written with outlines are those that are made one by one, character for character."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from annotations.language.forms import (
    Application,
    Constant,
    Form,
    Lambda,
    Variable,
    read_form,
    to_corpus,
)
from annotations.language.grounding import Anonymizer
from annotations.language.plans import ActionName, Lookup
from annotations.language.world import Entity, Ontology, Predicate, PredicateKind
from parser_service.parsers.interface import Candidate
from parser_service.serving.answer_writing import AnswerWriter
from parser_service.serving.parse_answers import as_json, read_answers
from parser_service.serving.preparing import WorldLanguage
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.annotations.language.sample_ontology import HOME

STARTER = Path(__file__).parents[3] / "annotations" / "starter" / "household"
# Texts that a gloss, a notation, JSON or a pattern might take for something else.
ODD = (
    "cup of tea", "half_pint", "lost person", "current", "that is it", "is land", "dish", "baby",
    'say "hi"', "back\\slash", "tea  spoon", "object0", "<room>", "\U000f0000", "\U000f0002 box",
    "\ud800", "3", "UNKNOWN", "a joke of yours", "___",
)  # fmt: skip
ODD_THINGS = Ontology(
    (
        *HOME.entities,
        *(Entity("object", text, (), {"category": "drinks"}) for text in ODD),
        *(Entity("location", f"{text} place", (), {"room": "attic"}) for text in ODD),
    )
)
PATTERNS = {
    "fetch": "fetch {1} | fetch {1} for {2:name}",
    "glued": "un{2}s _ | {2}",
    "both": "_ of {2}{3} | both_{2}",
    "sign": "\U000f0000 {2} _",
    "exact": "_ as it is{2=current} | that is {2:text}",
    "boxed": "{2} box",
    "after": "_ {2:text}",
    "is_like": "_ that is {2:text} | that {2} _",
}
ACTIONS = ("bring", "find", "count", "say", "put", "guide", "go", "fetch", "sequence", "answer")
TOLD = ("is_a", "at", "name", "person", "largest", "left_of", "is", "gesture", *PATTERNS)
TOKENS = ("object", "object", "location", "location", "room", "name", "category", "gesture")


def language_of(ontology: Ontology) -> WorldLanguage:
    """Return the language of a world with ``ontology`` and some predicates that a team said otherwise."""
    predicates = {
        name: Predicate(name, PredicateKind.DESCRIPTION, (), pattern)
        for name, pattern in PATTERNS.items()
    } | {"fetch": Predicate("fetch", PredicateKind.ACTION, (), PATTERNS["fetch"])}
    lookup = Lookup(ontology, predicates)
    names = {"bring": ActionName("Fetch", {"thing": "what"})}
    return WorldLanguage(ontology, predicates, Anonymizer(ontology), lookup, names)


def compare(
    writer: AnswerWriter, utterance: str, candidates: list[Candidate], score_kind: str = ""
) -> None:
    heard = writer.language.anonymizer.anonymize(utterance)
    answers = read_answers(heard, "", candidates, writer.language, score_kind)
    expected = [as_json(each) for each in answers.as_json()["candidates"]]
    assert [each.answer for each in writer.readings(heard, candidates, score_kind)] == expected


@st.composite
def descriptions(draw: st.DrawFn, level: int = 2) -> Form:
    """``(λ$1:e (is_a $1 "<object>") …)``, with other things described inside."""
    inside = st.sampled_from([f"<{name}>" for name in TOKENS]).map(Constant)
    numbers = st.sampled_from([2, 3]).map(Constant)
    leaves = st.one_of(inside, inside, numbers, st.sampled_from(ODD).map(Constant))
    arguments = st.one_of(leaves, descriptions(level - 1)) if level else leaves
    bodies = st.builds(
        lambda name, others: Application(name, (Variable(level), *others)),
        st.sampled_from(TOLD),
        st.lists(arguments, max_size=2),
    )
    return Lambda(level, "e", tuple(draw(st.lists(bodies, min_size=1, max_size=3))))


@st.composite
def commands(draw: st.DrawFn, level: int = 1) -> Form:
    tokens = st.sampled_from([f"<{name}>" for name in TOKENS]).map(Constant)
    arguments = st.one_of(descriptions(), descriptions(), tokens)
    if level:
        arguments = st.one_of(arguments, commands(level - 1))
    some = draw(st.lists(arguments, min_size=1, max_size=3))
    return Application(draw(st.sampled_from(ACTIONS)), tuple(some))


utterances = st.lists(
    st.sampled_from([*(each.text for each in ODD_THINGS.entities), "flurb", "from", "the", "or"]),
    max_size=6,
).map(lambda words: " ".join(["bring", *words]))
odd_writer = AnswerWriter(language_of(ODD_THINGS))


@pytest.mark.parametrize(
    "said",
    [
        *(f'({name} $1 "<object>")' for name in ("is_a", "name", "at", "largest", *PATTERNS)),
        '(is_a $1 "<object>") (person $1)',
        '(is_a $1 "<object>") (at $1 "<location>")',
        '(is_a $1 "<object>") (left_of $1 (λ$2:e (is_like $2 "<object>") (at $2 "<location>")))',
        '(at $1 "<location>") (exact $1 "current") (is_like $1 "<object>")',
    ],
)
@pytest.mark.parametrize(
    "do", ["(bring (λ$1:e {}))", "(say (count (λ$1:e {})))", "(find (λ$1:e {}) 3)"]
)
def test_odd_names_in_a_form_that_is_known_from_plain_ones(do: str, said: str) -> None:
    candidate = Candidate(to_corpus(read_form(do.format(said))), -1.5)
    compare(odd_writer, "bring the tea from the shelf", [candidate])
    for text in ODD:
        compare(odd_writer, f"bring {text} from the stool", [candidate])
        compare(odd_writer, f"bring {text} or the tea from the {text} place", [candidate])


@settings(max_examples=50)
@given(commands(), st.lists(utterances, min_size=2, max_size=4))
def test_whatever_is_named_in_whatever_form(form: Form, spoken: list[str]) -> None:
    for utterance in spoken:
        compare(odd_writer, utterance, [Candidate(to_corpus(form), -1.5)])


@pytest.mark.parametrize(
    "form", ["UNKNOWN", "no form", "(go UNKNOWN)", "(wait)", '(go "\U000f0001")']
)
def test_forms_without_places(form: str) -> None:
    writer = AnswerWriter(language_of(HOME))
    for score in (float("-inf"), 0.25, 1e-7):
        compare(writer, "go to the shelf <moon> <room>", [Candidate(form, score)])
    compare(writer, "go", [])


def test_published_forms_with_the_entities_of_other_utterances() -> None:
    """Once a form is known, an answer is only filled in with entities that it has not had before."""
    ontology, _ = read_ontology_folder(STARTER)
    writer = AnswerWriter(language_of(ontology))
    classes = {each.text.casefold(): each.entity_class for each in ontology.entities}
    lines = (STARTER / "paraphrases.txt").read_text(encoding="utf-8").splitlines()

    def with_token(text: re.Match[str]) -> str:
        entity_class = classes.get(text[1].casefold())
        return f'" <{entity_class}> "' if entity_class else text[0]

    forms = [re.sub('" ([^"]+) "', with_token, line) for line in lines[2::3]]
    for number, utterance in enumerate(lines[:450:3]):
        compare(writer, utterance, [Candidate(forms[number + step], -step) for step in (0, 1, 40)])
    outlines = writer._outlines.answer.cache_info()
    assert outlines.hits > 3 * outlines.misses


def test_an_outline_says_in_a_room_and_at_a_location(monkeypatch: pytest.MonkeyPatch) -> None:
    writer = AnswerWriter(language_of(HOME))
    room, location = (HOME.of_class(name)[-1].text for name in ("room", "location"))
    for entity_class, text in (("room", room), ("location", location)):
        form = f'(find (λ$1:e (person $1) (at $1 "<{entity_class}>")))'
        candidates = [Candidate(to_corpus(read_form(form)), -1.5)]
        compare(writer, f"find somebody at the {text}", candidates)
        with monkeypatch.context() as patched:
            patched.setattr(AnswerWriter, "_write_anew", None)  # the outline says it alone
            compare(writer, f"find somebody near the {text}", candidates)


def test_what_nobody_asks_for_is_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    writer = AnswerWriter(language_of(HOME))
    heard = writer.language.anonymizer.anonymize("go to the shelf")
    candidates = [Candidate(form, score) for form, score in (("(wait)", 0.9), ("UNKNOWN", 0.1))]
    written: list[str] = []
    monkeypatch.setattr(
        AnswerWriter, "_fill", lambda self, candidate, *_: written.append(candidate.form)
    )
    first, _ = writer.readings(heard, candidates, "probability")
    assert not written
    assert first.answer and first.executable_plans in (0, 1, 2)
    assert written == ["(wait)"]
