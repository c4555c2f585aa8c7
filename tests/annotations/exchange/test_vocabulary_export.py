"""What a speech recogniser is told to expect, and GET /api/v1/worlds/<w>/vocabulary/"""

from __future__ import annotations

import json

import pytest

from annotations.exchange.vocabulary_export import (
    UNKNOWN_WORD,
    PhraseKind,
    vocabulary_of,
    vocabulary_pieces,
)
from annotations.language.grounding import Anonymizer
from annotations.models import Entity, Production
from annotations.rows.from_rows import ontology_of
from tests.annotations.commands.run_command import run


def texts(phrases, *kinds):
    return [each.text for each in phrases if each.kind in kinds]


def add(world, entity_class, text, *aliases):
    position = Entity.objects.filter(ontology__world=world).count()
    return Entity.objects.create(
        ontology=world.ontology,
        entity_class=entity_class,
        text=text,
        aliases=list(aliases),
        position=position,
    )


def test_names_come_before_the_fixed_words_of_the_grammar(tiny_world):
    phrases = vocabulary_of(tiny_world)
    assert texts(phrases, PhraseKind.NAME) == [
        *("drinks", "tea", "milk", "kitchen", "sink", "bath"),
    ]
    assert texts(phrases, PhraseKind.WORD) == ["find", "go", "locate", "the", "to"]
    kinds = [each.kind for each in phrases]
    assert kinds.index(PhraseKind.WORD) == len(kinds) - 5


def test_aliases_and_plurals_say_which_entity_they_name(tiny_world):
    add(tiny_world, "object", "knife", "blade")
    named = {each.text: (each.kind, each.entity) for each in vocabulary_of(tiny_world)}
    assert named["blade"] == (PhraseKind.ALIAS, "knife")
    assert named["knives"] == named["blades"] == (PhraseKind.INFLECTED, "knife")
    assert named["drink"] == (PhraseKind.INFLECTED, "drinks")
    assert "pringleses" not in named


def test_what_is_no_english_gets_a_plural_all_the_same(tiny_world):
    add(tiny_world, "object", "7up")
    add(tiny_world, "object", "pringles")
    phrases = texts(vocabulary_of(tiny_world), PhraseKind.INFLECTED)
    assert "7ups" in phrases
    assert "pringleses" not in phrases


def test_nobody_is_said_in_the_plural(tiny_world):
    add(tiny_world, "name", "Grace")
    assert "Graces" not in texts(vocabulary_of(tiny_world), *PhraseKind)


def test_every_phrase_of_an_entity_is_understood_as_it(tiny_world):
    add(tiny_world, "object", "coffee mug", "cup")
    anonymizer = Anonymizer(ontology_of(tiny_world))
    for phrase in vocabulary_of(tiny_world, "names"):
        (span,) = anonymizer.anonymize(phrase.text).spans
        assert (span.start, span.end) == (0, len(phrase.text))


def test_pronouns_of_the_generator_are_words(tiny_world):
    Production.objects.filter(grammar__world=tiny_world, nonterminal="Main").update(
        expansion="bring it to {pron}, then say (hello | good bye)"
    )
    words = texts(vocabulary_of(tiny_world), PhraseKind.WORD)
    assert {"him", "her", "them", "hello", "bye"} <= set(words)
    assert not [word for word in words if "," in word or "{" in word]


def test_a_text_of_two_classes_is_one_line_and_two_rows(tiny_world):
    add(tiny_world, "object", "orange")
    add(tiny_world, "name", "orange")
    phrases = vocabulary_of(tiny_world)
    assert [each.entity_class for each in phrases if each.text == "orange"] == [
        "object",
        "name",
    ]
    lines = b"".join(vocabulary_pieces(phrases, "txt")).decode().splitlines()
    assert len(set(lines)) == len(lines)


def test_the_list_for_vosk_has_plain_words_and_one_for_all_others(tiny_world):
    add(tiny_world, "object", "Dr. Pepper")
    (line,) = b"".join(vocabulary_pieces(vocabulary_of(tiny_world), "vosk")).splitlines()
    listed = json.loads(line)
    assert "dr pepper" in listed
    assert listed[-1] == UNKNOWN_WORD
    assert len(set(listed)) == len(listed)


def test_an_empty_world_has_an_empty_file(world):
    assert not b"".join(vocabulary_pieces(vocabulary_of(world), "txt"))


def test_the_command_writes_the_file_and_counts(tiny_world, tmp_path):
    target = tmp_path / "words.jsonl"
    report, failure = run("export_vocabulary", "home", "--as", "jsonl", "--output", target)
    assert failure is None
    rows = [json.loads(line) for line in target.read_text().splitlines()]
    assert report["phrases"] == len(rows) == sum(report["kinds"].values())
    tea = {"text": "tea", "kind": "name", "entity_class": "object", "entity": "tea"}
    assert tea in rows


@pytest.mark.parametrize(
    ("query", "kind", "name"),
    [
        ("", "text/plain", "home-vocabulary.txt"),
        ("?as=jsonl", "application/jsonl", "home-vocabulary.jsonl"),
        ("?as=vosk", "application/json", "home-vocabulary.json"),
    ],
)
def test_members_get_it_over_rest(anna, tiny_world, query, kind, name):
    response = anna.get(f"/api/v1/worlds/home/vocabulary/{query}")
    assert response["Content-Type"].startswith(kind)
    assert f'filename="{name}"' in response["Content-Disposition"]
    assert b"kitchen" in b"".join(response.streaming_content)


@pytest.mark.parametrize("query", ["?as=moon", "?only=moon"])
def test_other_formats_and_parts_are_refused(anna, tiny_world, query):
    assert anna.get(f"/api/v1/worlds/home/vocabulary/{query}").status_code == 400


def test_names_or_words_alone(anna, tiny_world):
    def lines(query):
        response = anna.get(f"/api/v1/worlds/home/vocabulary/{query}")
        return set(b"".join(response.streaming_content).decode().splitlines())

    names, words = lines("?only=names"), lines("?only=words")
    assert "tea" in names and "find" in words
    assert not names & words
    assert names | words == lines("")


def test_the_page_of_the_ontology_offers_it(anna, tiny_world):
    page = anna.get("/w/home/ontology/").content.decode()
    assert "/api/v1/worlds/home/vocabulary/?as=txt" in page
