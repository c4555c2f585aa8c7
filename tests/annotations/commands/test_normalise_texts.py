"""manage.py normalise_texts --world W"""

from __future__ import annotations

import pytest

from annotations.generation.freezing import freeze_split
from annotations.generation.generating import generate_pairs
from annotations.labelling.collecting import collect
from annotations.models import AuditEntry, Entity, Example, Predicate, SemanticTemplate
from annotations.rows.history import keys_changed_by_people
from tests.annotations.commands.run_command import run
from tests.annotations.exchange.packing import everything_of
from tests.doubted_labels import say


@pytest.fixture
def odd_world(tiny_world, annotator):
    """A world that says what it said before, with something in it that does not show."""
    generate_pairs(tiny_world)
    freeze_split(tiny_world, "frozen")
    collect(tiny_world, ["bring me tea", "hello"], by=annotator)
    say(tiny_world, "how many girls")
    return tiny_world


def spoil(world):
    template = world.grammar.templates.first()
    entity = world.ontology.entities.first()
    SemanticTemplate.objects.filter(pk=template.pk).update(pattern=f"{template.pattern}\u200b")
    Entity.objects.filter(pk=entity.pk).update(text=f"\ufeff{entity.text}")
    world.utterances.filter(text="hello").update(text="hel\xadlo")
    world.paraphrases.update(utterance="how many\u200d girls")
    predicate = world.predicates.first()
    Predicate.objects.filter(pk=predicate.pk).update(gloss=f"{predicate.gloss}\u200b")
    example = Example.objects.filter(split__world=world).first()
    Example.objects.filter(pk=example.pk).update(utterance="go\u200b")
    return example


COUNTS = {"templates": 1, "entities": 1, "utterances": 1, "paraphrases": 1, "predicates": 1}


def texts_of(world):
    """Everything but versions and distances."""
    apart = ("version", "edit_distance", "jaccard_distance")
    return {
        name: [{key: value for key, value in row.items() if key not in apart} for row in rows]
        for name, rows in everything_of(world).items()
        if name not in ("world", "examples")
    }


def test_stored_texts_are_normalised_with_their_history(odd_world):
    before = texts_of(odd_world)
    example = spoil(odd_world)
    report, failure = run("normalise_texts", "--world", "home")
    assert failure is None and report["rows"] == COUNTS and report["problems"] == []
    assert texts_of(odd_world) == before
    example.refresh_from_db()
    assert example.utterance == "go\u200b"
    row = odd_world.utterances.get(text="hello")
    first, last = row.history.order_by("history_id")
    assert (first.text, last.text, last.version) == ("hel\xadlo", "hello", 2)
    assert last.history_user is None
    assert not keys_changed_by_people(Entity, odd_world)
    odd_world.refresh_from_db()
    assert not odd_world.commands_are_stale
    assert run("normalise_texts", "--world", "home")[0]["rows"] == {}


def test_a_dry_run_says_the_same_and_changes_nothing(odd_world):
    spoil(odd_world)
    before = everything_of(odd_world)
    report, failure = run("normalise_texts", "--world", "home", "--dry-run")
    assert failure is None and report["rows"] == COUNTS and report["is_dry_run"]
    assert everything_of(odd_world) == before


def test_rows_that_would_be_the_same_stay_and_are_named(odd_world):
    odd_world.utterances.filter(text="hello").update(text="bring me\u200b tea")
    kept, odd = odd_world.utterances.order_by("pk")
    report, failure = run("normalise_texts", "--world", "home")
    assert failure is None and report["rows"] == {}
    (problem,) = report["problems"]
    assert all(f"utterance {row.pk} " in problem["message"] for row in (odd, kept))
    odd.refresh_from_db()
    assert (odd.text, odd.version) == ("bring me\u200b tea", 1)


def test_a_text_of_which_nothing_would_show_stays_and_is_named(odd_world):
    odd_world.utterances.filter(text="hello").update(text="\u200b")
    report, _ = run("normalise_texts", "--world", "home")
    (problem,) = report["problems"]
    assert report["rows"] == {} and "text" in problem["message"].split()


def test_it_is_in_the_audit_log(odd_world):
    spoil(odd_world)
    run("normalise_texts", "--world", "home")
    entry = AuditEntry.objects.get(what="normalise texts")
    assert (entry.subject, entry.world) == ("5 rows", odd_world)
