"""Proposals of the machine for the errors of a run."""

from __future__ import annotations

import pytest

from annotations.background import Stopped
from annotations.background.progress import UNWATCHED, Unwatched
from annotations.labelling.audit_findings import store_findings
from annotations.models import Entity, Example, FindingStatus, Ontology
from parser_service.models import Prediction, Review, Slice
from parser_service.reviews import category_proposals
from parser_service.reviews.category_proposals import propose_for_run
from parser_service.reviews.world_categories import ensure_categories
from tests.doubted_labels import doubt
from tests.sample_world import answer, make_paraphrase, scored_run

GO = '( go " <room> " )'
BRING = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'
BIGGEST = "( bring ( lambda $1 e ( biggest $1 ) ) )"
LARGEST = "( bring ( lambda $1 e ( largest $1 ) ) )"
FIND = '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'


@pytest.fixture
def run(sample):
    """A run whose answers the test gives."""
    sample.run.predictions.all().delete()
    return sample.run


@pytest.fixture
def names(world):
    """Two rooms and an object that the world has."""
    ontology, _ = Ontology.objects.get_or_create(world=world)
    rows = [("room", "kitchen"), ("room", "bedroom"), ("object", "apple")]
    for position, (kind, text) in enumerate(rows, start=100):
        Entity.objects.create(ontology=ontology, entity_class=kind, text=text, position=position)


@pytest.fixture
def say(run):
    """Adds an example to the test part, with the first answer to it."""

    def add(utterance: str, label: str, form: str) -> Example:
        example = Example.objects.create(
            split=run.split,
            position=100 + run.split.examples.count(),
            part="test",
            source="paraphrased",
            utterance=utterance,
            logical_form=label,
        )
        answer(run, example, form)
        return example

    return add


def proposed(run, *attractors) -> dict[str, tuple[str, str]]:
    """Code and reason of each proposal by its utterance."""
    propose_for_run(run, frozenset(attractors), UNWATCHED)
    rows = run.reviews.proposed().select_related("example", "category")
    return {row.example.utterance: (row.category.code, row.reason) for row in rows}


def test_each_wrong_first_answer_of_both_parts_gets_a_proposal(sample):
    run = sample.run
    wrong = run.predictions.filter(is_exact_match=False)
    assert propose_for_run(run, frozenset(), UNWATCHED) == wrong.count() == 9
    rows = run.reviews.proposed()
    assert set(rows.values_list("example")) == set(wrong.values_list("example"))
    row = rows.select_related("category").first()
    assert row.reviewer is None and row.category.code == "wrong_predicate"
    assert row.answer == GO and "instead of" in row.reason


def test_only_the_first_answer_counts(run, say):
    example = say("walk over there", GO, GO)
    Prediction.objects.create(
        run=run,
        example=example,
        rank=2,
        logical_form=FIND,
        score=0,
        is_exact_match=False,
        is_equivalent=False,
        is_well_formed=True,
    )
    assert proposed(run) == {}


def test_what_is_no_form_is_ill_formed(run, say):
    say("walk", GO, "( go (")
    say("stroll", GO, "")
    assert {code for code, _ in proposed(run).values()} == {"ill_formed"}


def test_a_predicate_that_the_world_lacks_is_outside_the_ontology(run, say):
    say("dance", GO, "( dance UNKNOWN )")
    code, reason = proposed(run)["dance"]
    assert code == "outside_ontology" and "dance" in reason


def test_an_attractor_is_an_unexpected_default(run, say):
    say("bring the tea", BRING, GO)
    assert proposed(run, GO)["bring the tea"][0] == "unexpected_default"
    assert proposed(run)["bring the tea"][0] == "wrong_predicate"


def test_an_utterance_one_word_apart_makes_it_overly_sensitive(run, say):
    say("please fetch the big thing", BRING, BRING)
    say("please fetch the small thing", BRING, GO)
    code, reason = proposed(run)["please fetch the small thing"]
    assert code == "overly_sensitive" and "please fetch the big thing" in reason


def test_punctuation_does_not_hide_a_neighbour(run, say):
    say("fetch the thing", BRING, GO)
    say("Fetch the thing!", BRING, GO)
    say("fetch a thing", BRING, BRING)
    assert {code for code, _ in proposed(run).values()} == {"overly_sensitive"}


def test_another_label_of_the_same_text_makes_it_ambiguous(run, say):
    say("get the tea", BRING, FIND)
    other = say("get the tea", FIND, FIND)
    Example.objects.filter(pk=other.pk).update(part="train")
    code, reason = proposed(run)["get the tea"]
    assert code == "ambiguous_utterance" and reason


def test_the_same_text_with_another_name_in_training_makes_it_ambiguous(run, say, names):
    say("get the kitchen", GO, FIND)
    other = say("Get a bedroom", FIND, FIND)
    assert proposed(run)["get the kitchen"][0] == "wrong_predicate"
    Example.objects.filter(pk=other.pk).update(part="train")
    assert proposed(run)["get the kitchen"][0] == "ambiguous_utterance"


def test_a_label_with_a_place_that_nobody_names_is_a_wrong_gold_label(run, say, names):
    at_room = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )'
    say("bring the apple", at_room, BRING)
    say("bring the apple from the kitchen", at_room, BRING)
    found = proposed(run)
    assert found["bring the apple"][0] == "wrong_gold_label"
    assert found["bring the apple from the kitchen"][0] == "missing_constraint"


def test_another_parser_with_the_same_answer_speaks_against_a_label_that_training_has(
    run, say, names
):
    known = run.split.examples.filter(part="train").first().logical_form
    asked = [say("serve an apple", known, FIND), say("hand me an apple", BIGGEST, FIND)]
    other = scored_run(run.world, run.split, "seq2seq", right=0)
    for example in asked:
        answer(other, example, FIND)
    found = proposed(run)
    assert found["serve an apple"][0] == "wrong_gold_label"
    assert found["serve an apple"][1].startswith("seq2seq ")
    assert found["hand me an apple"][0] != "wrong_gold_label"


def test_what_the_label_audit_suggests_is_a_wrong_gold_label(run, say):
    doubted = make_paraphrase(run.world, "go", "fetch it", logical_form=FIND, grounded_form=FIND)
    store_findings(run.world, [doubt(doubted, BRING)])
    say("fetch it", FIND, BRING)
    code, reason = proposed(run)["fetch it"]
    assert code == "wrong_gold_label" and reason
    run.world.audit_findings.update(status=FindingStatus.CORRECTED, decided_form=BRING)
    code, corrected = proposed(run)["fetch it"]
    assert code == "wrong_gold_label" and corrected != reason
    run.world.audit_findings.update(status=FindingStatus.KEPT, decided_form=FIND)
    assert proposed(run)["fetch it"][0] == "wrong_predicate"


def test_a_label_that_its_own_words_contradict_is_a_wrong_gold_label(run, say):
    text = "bring the largest one"
    say(text, BIGGEST, LARGEST)
    code, reason = proposed(run)[text]
    assert code == "wrong_gold_label"
    assert "“largest”" in reason and "“biggest”" in reason
    kept = make_paraphrase(run.world, "go", text, logical_form=BIGGEST, grounded_form=BIGGEST)
    store_findings(run.world, [doubt(kept, LARGEST)])
    run.world.audit_findings.update(status=FindingStatus.KEPT, decided_form=BIGGEST)
    assert proposed(run)[text][0] != "wrong_gold_label"


def test_proposals_replace_earlier_ones_and_leave_people_alone(run, say, reviewer):
    first = say("bring the tea", BRING, GO)
    second = say("bring the milk", BRING, GO)
    own = Review.objects.create(run=run, example=first, reviewer=reviewer, note="Why?")
    proposed(run)
    run.predictions.filter(example=second).update(logical_form=BRING, is_exact_match=True)
    proposed(run, GO)
    left = run.reviews.proposed().get()
    assert left.example == first and left.category.code == "unexpected_default"
    assert Review.objects.filter(pk=own.pk, note="Why?").exists()


def test_other_runs_keep_their_proposals(sample):
    other = scored_run(sample.world, sample.split, seed=1)
    propose_for_run(other, frozenset(), UNWATCHED)
    propose_for_run(sample.run, frozenset(), UNWATCHED)
    assert other.reviews.count() == sample.run.reviews.count() == 9


def test_a_category_that_the_world_has_deleted_makes_room_for_the_next(run, say):
    ensure_categories(run.world)["unexpected_default"].delete()
    say("bring the tea", BRING, GO)
    assert proposed(run, GO)["bring the tea"][0] == "wrong_predicate"


def test_a_stop_between_two_batches_keeps_whole_batches(sample, monkeypatch):
    monkeypatch.setattr(category_proposals, "BATCH", 4)

    class Stopping(Unwatched):
        def report(self, fraction: float, message: str) -> None:
            if fraction > 0.4:
                raise Stopped

    with pytest.raises(Stopped):
        propose_for_run(sample.run, frozenset(), Stopping())
    assert sample.run.reviews.count() == 4
    assert propose_for_run(sample.run, frozenset(), UNWATCHED) == 9
    assert sample.run.reviews.count() == 9


def test_equal_pairs_of_forms_are_read_once(run, say, monkeypatch):
    calls = []
    whole = category_proposals.propose_category
    monkeypatch.setattr(
        category_proposals, "propose_category", lambda *given: calls.append(given) or whole(*given)
    )
    for thing in ("red door", "green hill far", "blue"):
        say(f"{thing} {thing}", BRING, GO)
    assert len(proposed(run)) == 3 and len(calls) == 1


def test_an_error_that_no_earlier_run_of_the_parser_made_is_new(sample):
    propose_for_run(sample.run, frozenset(), UNWATCHED)
    assert not sample.run.reviews.exclude(is_new=None).exists()  # there is nothing to compare with
    other = scored_run(sample.world, sample.split, parser="seq2seq", right=0)
    later = scored_run(sample.world, sample.split, right=0, seed=1)
    propose_for_run(other, frozenset(), UNWATCHED)
    propose_for_run(later, frozenset(), UNWATCHED)
    assert not other.reviews.exclude(is_new=None).exists()
    assert later.reviews.filter(is_new=False).count() == 9
    assert later.reviews.filter(is_new=True).count() == 3


def test_a_slice_proposes_its_category_where_there_is_no_stronger_evidence(run, say):
    saved = Slice.objects.create(world=run.world, name="tea", query="q=tea")
    categories = ensure_categories(run.world)
    categories["overly_sensitive"].slice = saved
    categories["overly_sensitive"].save()
    say("bring the tea", BRING, GO)
    say("fetch some milk", BRING, GO)
    say("serve black tea now", BRING, "( go (")
    found = proposed(run)
    code, reason = found["bring the tea"]
    assert code == "overly_sensitive" and "“tea”" in reason
    assert found["fetch some milk"][0] == "wrong_predicate"
    assert found["serve black tea now"][0] == "ill_formed"
