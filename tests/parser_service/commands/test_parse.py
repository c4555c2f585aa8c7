"""``manage.py parse``: an utterance and what a trained parser makes of it."""

from __future__ import annotations

import json
from io import StringIO

import pytest
from django.core.management import CommandError, call_command

from annotations.models import Entity, Ontology, Split
from parser_service.models import TrainingRun
from parser_service.runs import lifecycle, run_requests
from parser_service.runs.checkpoints import model_folder, remove_folder
from parser_service.runs.promoting import promote
from parser_service.runs.train_run import train
from parser_service.serving.default_runs import best_run
from tests.parser_service.made_up import TINY, make_split

FETCH = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'
FETCH_CUP = '( bring ( lambda $1 e ( is_a $1 " red cup " ) ) )'


@pytest.fixture
def split(world, transactional_db):
    ontology = Ontology.objects.create(world=world)
    for position, (kind, text) in enumerate([("object", "red cup"), ("room", "kitchen")]):
        Entity.objects.create(ontology=ontology, entity_class=kind, text=text, position=position)
    return make_split(world)


def trained(split, parser="knn", **asked):
    run, _ = run_requests.request(split.world, split, parser, send=False, **asked)
    train(lifecycle.claim("the test", run.queue, run))
    run.refresh_from_db()
    assert run.status == "succeeded"
    return run


def answering(split, **asked):
    """Train a run that is the learned part of what answers."""
    run = trained(split, **asked)
    promote(run, None)
    return run


def ask(text: str, *options: str) -> dict:
    out = StringIO()
    call_command("parse", text, "--world", "home", *options, "--json", stdout=out)
    return json.loads(out.getvalue())


@pytest.mark.parametrize("sources", ["gen", "gen+para"])
def test_every_parser_is_asked_as_people_speak_as_it_was_evaluated(split, sources):
    run = answering(split, train_sources=sources)
    answer = ask("Bring me the red cup")
    assert (answer["run"], answer["parser"]) == (run.pk, "knn")
    assert answer["parsed_text"] == "Bring me the red cup"


@pytest.mark.parametrize(
    "asked", ["bring me the red c\u00adup", "bring\u200b me the\u00a0red cup\ufeff"]
)
def test_what_does_not_show_changes_no_answer(split, asked):
    answering(split, train_sources="gen")
    assert ask(asked) == ask("bring me the red cup")
    with pytest.raises(CommandError):
        ask("\u200b")


def test_an_answer_names_the_entities_that_the_utterance_names(split):
    answering(split, train_sources="gen")
    answer = ask("Bring me the red cup")
    first = answer["candidates"][0]
    assert (first["form"], first["grounded"]) == (FETCH, FETCH_CUP)
    assert first["reading"] == 'bring(λx. is_a(x, "red cup"))'
    assert first["english"] == "bring me the red cup"


def test_a_network_is_loaded_from_its_folder(split):
    run = trained(split, "seq2seq", config={**TINY, "epochs": 1})
    assert ask("find the red cup", "--run", str(run.pk), "--beam", "2")["parser"] == "seq2seq"


def test_the_best_run_is_the_one_that_is_right_on_paraphrases(split):
    spoken = trained(split, train_sources="gen+para")
    generated = trained(split, train_sources="gen")
    for run, source, accuracy in ((spoken, "para", 0.5), (generated, "para", 0.25)):
        of_run = run.evaluations.filter(part="validation", test_source=source)
        of_run.update(accuracy=accuracy, interval_low=accuracy / 2)
    generated.evaluations.filter(test_source="gen").update(accuracy=1.0, interval_low=1.0)
    assert best_run(split.world) == spoken


def test_of_two_runs_the_surer_one_is_the_best(split):
    sure, lucky = trained(split, train_sources="gen+para"), trained(split, train_sources="gen")
    for run, accuracy, low in ((sure, 0.8, 0.7), (lucky, 0.9, 0.5)):
        run.evaluations.filter(test_source="para").update(accuracy=accuracy, interval_low=low)
    assert best_run(split.world) == sure


def test_the_promoted_run_is_asked_where_none_is_named(split):
    promoted = trained(split, train_sources="gen")
    answering(split, train_sources="gen+para")
    assert ask("find the red cup")["run"] != promoted.pk
    promote(promoted, None)
    assert ask("find the red cup")["run"] == promoted.pk


def test_a_run_of_a_split_by_form_is_not_better_for_being_right_more_often(split):
    by_command = trained(split, train_sources="gen+para")
    by_form = trained(split, train_sources="gen")
    other = Split.objects.create(world=split.world, name="forms", criterion="logical_form", seed=0)
    TrainingRun.objects.filter(pk=by_form.pk).update(split=other)
    by_form.evaluations.update(accuracy=1.0, interval_low=1.0)
    by_command.evaluations.update(accuracy=0.5, interval_low=0.25)
    assert best_run(split.world) == by_command
    TrainingRun.objects.filter(pk=by_command.pk).update(split=other)
    assert best_run(split.world) == by_form


def warnings(text: str) -> list[str]:
    answer = ask(text)
    return [*answer["warnings"], *answer["candidates"][0]["warnings"]]


def test_what_the_world_does_not_know_gets_a_warning(split):
    answering(split, train_sources="gen")
    assert warnings("bring me the red cup") == []
    assert warnings("bring me the moon") == [
        "<object> stays open: the utterance names no object of this world."
    ]
    Entity.objects.create(
        ontology=split.world.ontology, entity_class="object", text="bowl", position=2
    )
    assert warnings("bring me the bowl the red cup") == [
        "<object> stays open: it may be bowl or red cup."
    ]
    assert warnings("bring me the <gadget>")[0].startswith("<gadget> is not a class of entities.")
    Entity.objects.filter(entity_class="object").delete()
    assert warnings("bring me the <object>") == [
        "<object>: this world has no entity of the class object.",
        "<object> stays open: this world has no entity of the class object.",
    ]


def test_warnings_are_printed_for_a_person(split):
    answering(split, train_sources="gen")
    out = StringIO()
    call_command("parse", "bring me the moon", "--world", "home", stdout=out)
    assert out.getvalue().endswith("the utterance names no object of this world.\n")


def test_the_steps_of_the_task_plan_are_printed_for_a_person(split):
    answering(split, train_sources="gen")
    out = StringIO()
    call_command("parse", "bring me the red cup", "--world", "home", stdout=out)
    assert "       1  find_object(the red cup)\n" in out.getvalue()
    assert "       4  give(" in out.getvalue() or "       3  give(" in out.getvalue()


def test_an_utterance_without_an_answer_has_no_candidates(split):
    answering(split, config={"least_overlap": 0.9})
    assert ask("sing a song")["candidates"] == []


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ((), r"\bhome\b"),
        (("--run", "99"), r"\b99\b.*\bhome\b"),
        (("--beam", "0"), r"--beam .*\b1\b"),
    ],
)
def test_what_cannot_be_answered_is_a_sentence(split, options, named):
    with pytest.raises(CommandError, match=named):
        ask("bring me the red cup", *options)


def test_a_run_that_has_not_succeeded_is_not_asked(split):
    run, _ = run_requests.request(split.world, split, "knn", send=False)
    with pytest.raises(CommandError, match=rf"\b{run.pk}\b.*queued"):
        ask("bring me the red cup", "--run", str(run.pk))


def test_a_parser_whose_folder_is_gone_says_where_it_was(split):
    run = answering(split)
    remove_folder(model_folder(run.pk))
    with pytest.raises(CommandError, match=str(model_folder(run.pk))) as refused:
        ask("bring me the red cup")
    assert refused.value.__cause__.code == "saved_parser_missing"
