"""``manage.py audit_labels``: the labels that may be wrong."""

from __future__ import annotations

import json
from io import StringIO

import pytest
from django.core.management import CommandError, call_command

from annotations.exchange.generator_import import import_generator
from annotations.exchange.pair_import import import_pairs
from annotations.generation.generating import generate_pairs
from annotations.language.corpus.label_errors import Reason
from annotations.models import Command, Paraphrase
from annotations.models.corpus import ParaphraseStatus
from parser_service.labelling.audit_job import audit_labels

GO, FIND = '( go " <room> " )', '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'
SAID = {
    "find the tea": (FIND, "where is the tea"),
    "locate the tea": (FIND, "look for the milk"),
    "go to the kitchen": (GO, "walk into the bath"),
}


def ask(*options: str) -> dict:
    out = StringIO()
    call_command("audit_labels", "--world", "home", *options, "--json", stdout=out)
    return json.loads(out.getvalue())


def say(world, prompt, utterance, form, **columns):
    text = prompt.replace("tea", "<object>").replace("kitchen", "<room>")
    return Paraphrase.objects.create(
        world=world,
        command=Command.objects.filter(world=world, anonymized_text=text).first(),
        prompt=prompt,
        utterance=utterance,
        grounded_form=form,
        logical_form=form,
        edit_distance=1,
        jaccard_distance=0.5,
        position=world.paraphrases.count(),
        **columns,
    )


@pytest.fixture
def paraphrases(sample):
    return {
        prompt: say(sample.world, prompt, utterance, form)
        for prompt, (form, utterance) in SAID.items()
    }


def test_labels_that_are_right_have_only_the_parser_against_them(paraphrases):
    report = ask("--folds", "3")
    assert report["pairs"] == 3
    assert (report["reasons"]["command"], report["reasons"]["word"]) == (0, 0)


def test_a_wrong_label_is_first_with_the_form_of_its_command(sample, paraphrases):
    wrong = say(sample.world, "locate the tea", "look for the tea", GO)
    first = ask("--folds", "3")["labels"][0]
    assert first["pair"] == f"paraphrase-{wrong.pk}"
    assert first["utterance"] == "look for the <object>"
    assert (first["form"], first["suggested_form"]) == (GO, FIND)
    assert first["findings"][0]["reason"] == "command"
    assert "“locate the <object>”" in first["findings"][0]["sentence"]


def test_what_was_rejected_is_not_audited(sample, paraphrases):
    say(sample.world, "find the tea", "walk", GO, status=ParaphraseStatus.REJECTED)
    assert ask("--folds", "3")["pairs"] == 3


def test_the_report_for_a_person_shows_label_and_suggestion(sample, paraphrases):
    say(sample.world, "locate the tea", "look for the tea", GO)
    out = StringIO()
    call_command("audit_labels", "--world", "home", "--folds", "3", "--most", "1", stdout=out)
    text = out.getvalue()
    assert " of 4 " in text
    assert f"label:     {GO}\n   suggested: {FIND}" in text
    assert "\n2. " not in text


def test_a_world_with_too_few_pairs_is_told_so(sample):
    with pytest.raises(CommandError, match=r"\b5\b") as refused:
        ask()
    assert refused.value.__cause__.code == "too_few_commands"
    with pytest.raises(CommandError, match=r"--most .*\b0") as refused:
        ask("--most", "0")
    assert refused.value.__cause__.code == "option_out_of_range"


def test_the_published_faults_are_among_the_first(shared_data, world):
    """Of the 23 published labels that say "male" of females, this copy holds two."""
    assert not import_generator(world.name, shared_data / "generator-2018").is_refused
    generate_pairs(world)
    assert not import_pairs(world.name, "walker", shared_data / "walker2019").is_refused
    suspects = audit_labels(world).suspects
    assert {each.pair.utterance for each in suspects[:2]} == {
        "of the people who are in the room , which are girls?",
        "How many females are in the <room>?",
    }
    for each in suspects[:2]:
        assert each.reasons >= {Reason.COMMAND, Reason.WORD}
        assert each.suggested_form == each.pair.form.replace("male", "female")
    swapped = [
        finding
        for each in suspects[:50]
        for finding in each.findings
        if "biggest" in finding.sentence and "largest" in finding.sentence
    ]
    assert len(swapped) >= 30
