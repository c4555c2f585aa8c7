"""Places that readers give are places of the text that they were given, whatever folding does to its letters."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from annotations.language.corpus.names import EntityName, rename_in_utterance
from annotations.language.grounding import Anonymizer, HearingReader
from annotations.language.grounding.hearing import HeardText
from annotations.language.plans import StoppingWords, cut_at_joints, objections, sentences
from annotations.language.texts.text import find_words, normalise, normalise_line, places_of
from annotations.language.world import Entity, Ontology

ROOT = Path(__file__).parents[3]
# Their folded forms have other lengths: ß, İ, ŉ, ﬁ, ǰ, ΐ, ẖ, full-width letters, marks of their own, joined emoji.
ODD = [
    "Weißbier",
    "İzmir",
    "ŉ",
    "ﬁg",
    "ǰam",
    "ΐ",
    "ẖ",
    "ＴＥＡ",
    "x\u0302y",
    "STRASSE",
    "Straße",
    "👩\u200d🍳",
    "ಕಾಫಿ",
]
NAMES = ["Weißbier", "İzmir chair", "ﬁg", "ǰam", "x\u0302y", "ಕಾಫಿ", "tea", "kitchen", "Straße"]
ONTOLOGY = Ontology(
    (
        *tuple(Entity("object", normalise_line(name)) for name in NAMES),
        Entity("room", "kitchen"),
        Entity("name", "Bo"),
    )
)
WORDS = [
    "bring",
    "me",
    "the",
    "uhm",
    "and",
    "to",
    "no",
    "do not",
    "the the",
    "tea",
    "kitchen",
    "Bo's",
    ",",
    ".",
    "if",
]
UTTERANCES = st.lists(st.sampled_from([*ODD, *NAMES, *WORDS]), min_size=1, max_size=9).map(
    lambda words: normalise_line(" ".join(words))
)
VOCABULARY = ("bring", "me", "the", "<object>", "to", "<room>", "and", ",")
READER = HearingReader(ONTOLOGY, VOCABULARY)
STOPPING = StoppingWords(ONTOLOGY, VOCABULARY)


def are_the_same(one: str, other: str) -> bool:
    return one.casefold() == other.casefold()


@given(UTTERANCES)
def test_names_are_found_where_they_stand(utterance):
    heard = Anonymizer(ONTOLOGY).anonymize(utterance)
    end = 0
    for span in heard.spans:
        assert end <= span.start < span.end <= len(utterance)
        assert are_the_same(utterance[span.start : span.end], span.value)
        end = span.end


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("said", [str, str.upper, str.lower, str.title])
def test_each_name_is_found_in_any_case_beside_any_letter(name, said):
    name = normalise_line(name)
    if not are_the_same(said(name), name):  # "ŉ".upper() is another word
        pytest.skip("another word")
    for odd in map(normalise_line, ODD):
        utterance = normalise_line(f"{odd} {odd} put the {said(name)} here")
        last = Anonymizer(ONTOLOGY).anonymize(utterance).spans[-1]
        assert are_the_same(utterance[last.start : last.end], name)


@settings(deadline=None)
@given(UTTERANCES)
def test_what_was_heard_otherwise_is_quoted_from_where_it_stands(utterance):
    for lattice in READER.lattices(utterance):
        for span in lattice.spans:
            assert (
                utterance[span.start : span.end].strip() == utterance[span.start : span.end] != ""
            )
        for change in lattice.changes:
            assert utterance[change.start : change.end] == change.said
    clean: HeardText = READER.clean(utterance)
    for change in clean.changes:
        assert utterance[change.start : change.end] == change.said


@given(UTTERANCES)
def test_pieces_and_objections_quote_from_where_they_stand(utterance):
    for piece in (
        *sentences(utterance),
        *cut_at_joints(utterance, lambda texts: [None] * len(texts)),
    ):
        assert utterance[piece.start : piece.end] == piece.text
    heard = Anonymizer(ONTOLOGY).anonymize(utterance)
    for each in STOPPING.in_(heard):
        said = utterance[each.start : each.end]
        assert said == said.strip() and said in each.message
    for each in objections(heard):
        assert 0 <= each.start <= each.end <= len(utterance)


@given(UTTERANCES, st.data())
def test_words_are_found_in_the_text_that_has_them(utterance, data):
    words = utterance.split()
    first = data.draw(st.integers(0, len(words) - 1))
    last = data.draw(st.integers(first + 1, len(words)))
    wanted = " ".join(words[first:last])
    for spelling in (wanted, wanted.casefold()):
        place = find_words(spelling, utterance)
        assert place is not None
        assert are_the_same(utterance[slice(*place)], spelling)


@pytest.mark.parametrize(
    "utterance, words",
    [
        ("bring the Weißbier to the kitchen", "kitchen"),
        ("put the Weißbier beside my chai", "chai"),
        ("put the steak beside the tea", "TEA"),
        ("İ go to the Straße", "straße"),
    ],
)
def test_words_are_found_whole(utterance, words):
    start, end = find_words(words, utterance)
    assert are_the_same(utterance[start:end], words)
    assert find_words(words[:-1], utterance) is None


def test_a_name_is_renamed_where_it_stands():
    name = EntityName("object", "tea")
    renamed = rename_in_utterance(
        "İ, put the Weißbier by the tea", name, "mate", Anonymizer(ONTOLOGY)
    )
    assert renamed == "İ, put the Weißbier by the mate"


@given(st.text())
def test_words_keep_the_marks_of_their_letters(text):
    text = normalise(text)
    places = places_of(re.compile(r"\w+"), text)
    assert [text[start:end] for start, end in places] == [text[slice(*each)] for each in places]
    assert all(start < end for start, end in places)


SEARCHES = {"find", "rfind", "index", "rindex", "finditer", "search"}
FOLDS = {"casefold", "lower", "upper", "normalize", "fold"}


@pytest.mark.parametrize("app", ["annotations", "parser_service", "gpsr_site"])
def test_nothing_looks_for_a_place_in_a_folded_text(app):
    """Fold word by word instead (``places_of``, ``find_words``)."""
    found = []
    for path in sorted((ROOT / app).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
                continue
            if node.func.attr not in SEARCHES:
                continue
            calls = (
                each for each in (node.func.value, *node.args[-1:]) if isinstance(each, ast.Call)
            )
            called = {getattr(each.func, "attr", getattr(each.func, "id", "")) for each in calls}
            if called & FOLDS:
                found.append(f"{path.relative_to(ROOT)}:{node.lineno}")
    assert found == []
