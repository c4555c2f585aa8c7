"""Examples of splits go back to people as the rows that they were copied from."""

from __future__ import annotations

import pytest

from annotations.labelling import sent_examples
from annotations.labelling.sent_examples import send_examples
from annotations.language.texts.errors import Refusal
from annotations.models import Example, Utterance, WorkItem
from tests.sample_world import make_paraphrase

FIND = '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'


def make_example(split, utterance: str, source: str = "paraphrased", form: str = FIND) -> Example:
    return Example.objects.create(
        split=split,
        position=split.examples.count() + 1000,
        part="validation",
        source=source,
        utterance=utterance,
        logical_form=form,
    )


@pytest.fixture
def split(sample):
    return sample.split


def send(world, reviewer, *examples):
    return send_examples(world, examples, "Is that right?", reviewer)


def test_the_paraphrase_behind_an_example_is_asked_about(world, split, reviewer):
    other = make_paraphrase(world, utterance="where is it", logical_form="UNKNOWN")
    row = make_paraphrase(world, utterance="where is it", logical_form=FIND)
    sent = send(world, reviewer, make_example(split, "where is it"))
    item = WorkItem.objects.get()
    assert (item.paraphrase, item.kind) == (row, "requested")
    assert row != other
    assert item.reason.startswith(f"{reviewer} ") and item.reason.endswith(" Is that right?")
    assert sent.sentence.startswith("1 item ")
    assert not Utterance.objects.exists()


def test_the_template_behind_a_generated_example_is_asked_about_once(world, split, reviewer):
    commands = list(world.commands.select_related("template"))
    examples = [make_example(split, each.anonymized_text, "generated") for each in commands]
    sent = send(world, reviewer, *examples)
    templates = {each.template for each in commands}
    assert {item.template for item in WorkItem.objects.all()} == templates
    assert (sent.utterances, sent.queued) == (len(commands), len(templates))


def test_texts_that_were_frozen_with_invisible_characters_are_asked_about(world, split, reviewer):
    examples = [
        make_example(split, "where is\u200b it"),
        make_example(split, "take the cafe\u0301"),
    ]
    row = Utterance.objects.create(world=world, text="where is it", anonymized_text="where is it")
    assert send(world, reviewer, *examples).queued == 2
    assert {item.utterance.text for item in WorkItem.objects.all()} == {
        row.text,
        "take the caf\u00e9",
    }


def test_an_utterance_with_the_same_text_is_asked_about(world, split, reviewer):
    row = Utterance.objects.create(world=world, text="where is it", anonymized_text="where is it")
    send(world, reviewer, make_example(split, "where  is it"))
    assert WorkItem.objects.get().utterance == row


def test_a_text_without_a_row_becomes_a_new_utterance(world, split, reviewer):
    send(world, reviewer, make_example(split, "where is my cup"))
    row = Utterance.objects.get()
    assert (row.text, row.origin, row.status) == ("where is my cup", "review", "unlabelled")
    assert WorkItem.objects.get().utterance == row


def test_equal_texts_are_sent_once_and_what_waits_is_not_sent_again(world, split, reviewer):
    examples = [
        make_example(split, "where is it"),
        make_example(split, "where is it", form="UNKNOWN"),
    ]
    assert send(world, reviewer, *examples).queued == 1
    again = send(world, reviewer, *examples)
    assert again.queued == 0
    assert again.sentence.startswith("0 items ") and "; 1 " in again.sentence
    assert WorkItem.objects.count() == 1


def test_a_text_that_cannot_be_an_utterance_is_left_out_and_told(world, split, reviewer):
    examples = [make_example(split, "x" * 501), make_example(split, "where is it")]
    sent = send(world, reviewer, *examples)
    assert (sent.queued, sent.left_out) == (1, 1)
    assert "1 " in sent.sentence.partition(";")[2]


def test_too_many_are_refused_with_a_sentence_and_nothing_is_stored(
    world, split, reviewer, monkeypatch
):
    monkeypatch.setattr(sent_examples, "MOST_SENT", 2)
    examples = [make_example(split, f"where is cup {number}") for number in range(3)]
    with pytest.raises(Refusal) as refused:
        send(world, reviewer, *examples)
    assert refused.value.code == "nothing_to_send"
    assert not WorkItem.objects.exists() and not Utterance.objects.exists()


def test_the_split_stays_as_it_is(world, split, reviewer):
    example = make_example(split, "where is it")
    before = list(split.examples.values())
    send(world, reviewer, example)
    assert list(split.examples.values()) == before
