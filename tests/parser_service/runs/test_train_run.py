"""One run from its claim to its end, in this process."""

from __future__ import annotations

import errno
import threading
from pathlib import Path

import pytest
from django.db import OperationalError
from safetensors import SafetensorError

from annotations.language.texts.errors import Refusal
from parser_service.models import TrainingRun
from parser_service.parsers import registry
from parser_service.parsers.interface import Parser
from parser_service.parsers.knn import NearestNeighbour
from parser_service.parsers.pretrained_files import missing_weights
from parser_service.runs import lifecycle, run_requests
from parser_service.runs.checkpoints import model_folder, stored_folder
from parser_service.runs.knowledge import knowledge_of
from parser_service.runs.train_run import make_parser, sentence_of, train
from tests.parser_service.made_up import LONG, TINY, make_split

SHORT = {**TINY, "epochs": 4, "patience": 4}


def claimed(split, parser: str = "knn", **asked) -> TrainingRun:
    run, _ = run_requests.request(split.world, split, parser, send=False, **asked)
    claimed_run = lifecycle.claim("the test", run.queue, run)
    assert claimed_run is not None
    return claimed_run


def trained(split, parser: str = "knn", **asked) -> TrainingRun:
    run = claimed(split, parser, **asked)
    train(run)
    run.refresh_from_db()
    return run


@pytest.fixture
def split(world, transactional_db):
    """The lease is kept by a thread, which has to see what the test wrote."""
    return make_split(world)


def test_a_run_ends_succeeded_with_its_model_figures_and_log(split):
    run = trained(split, "seq2seq", config=SHORT)
    assert (run.status, run.failure, run.progress) == ("succeeded", "", 1.0)
    assert run.parameters > 0
    assert run.seconds_trained > 0
    assert run.epochs.count() == 4
    parser = registry.load_class("seq2seq").load(model_folder(run.pk))
    utterances = [example.utterance for example in run.split.examples.filter(part="test")]
    best = run.predictions.best().filter(example__part="test").order_by("example")
    answers = parser.predict(utterances, beam_width=5)
    assert [row.logical_form for row in best] == [ranked[0].form for ranked in answers]
    assert run.events.first().message == "Attempt 1 begins on the test."
    assert run.events.last().message == "Finished."


def test_what_a_parser_learns_from_is_what_was_asked_for(split):
    for sources, count in (("gen", 24), ("para", 24), ("gen+para", 48)):
        run = trained(split, train_sources=sources)
        assert run.events.filter(message__startswith=f"{count} pairs to train on").exists()


def test_a_parser_is_handed_no_more_than_its_protocol_allows(split):
    assert knowledge_of(split.world, "strict").protocol == "strict"
    assert knowledge_of(split.world, "domain").protocol == "domain"
    assert knowledge_of(split.world, "grammar").protocol == "grammar"
    assert make_parser(claimed(split)).knowledge.protocol == "strict"


def test_what_a_parser_refuses_becomes_the_failure_of_the_run(split):
    run = trained(split, "grammar-oracle", protocol="grammar")
    assert run.status == "failed"
    assert "grammar" in run.failure and run.events.last().message == run.failure


@pytest.mark.parametrize(
    ("error", "named"),
    [
        (Refusal("There is no pair. Add one."), "There is no pair. Add one."),
        (OSError(errno.ENOSPC, "No space left"), "GPSR_VAR_DIR"),
        (MemoryError(), "memory"),
        (KeyError("x"), "(KeyError)"),
    ],
)
def test_a_failure_says_what_happened_and_what_to_do(error, named):
    assert named in sentence_of(error)


def test_training_that_is_cancelled_stops_long_before_its_end(split):
    run = claimed(split, "seq2seq", config=LONG)
    threading.Timer(1.0, lifecycle.cancel, [run]).start()
    train(run)
    run.refresh_from_db()
    assert run.status == "cancelled"
    assert run.epochs.count() < LONG["epochs"] / 10


def test_training_that_lost_its_run_leaves_everything_to_the_other(split):
    run = claimed(split, "seq2seq", config=LONG)
    taken = TrainingRun.objects.filter(pk=run.pk)
    threading.Timer(1.0, taken.update, kwargs={"attempt": 2, "worker": "another"}).start()
    train(run)
    run.refresh_from_db()
    assert (run.status, run.attempt, run.worker) == ("running", 2, "another")
    assert not run.predictions.exists()


def interrupted(split, epochs: int) -> TrainingRun:
    """A run whose first attempt died after some epochs, claimed again."""
    run = claimed(split, "seq2seq", config={**SHORT, "epochs": 8})

    class Killed(BaseException):
        pass

    def die(message: str) -> None:
        if message.startswith(f"Epoch {epochs + 1}"):
            raise Killed

    with pytest.raises(Killed):
        train(run, tell=die)
    lifecycle.hand_back("the test")
    return lifecycle.claim("the test", run.queue, run)


def test_an_interrupted_run_goes_on_after_its_last_checkpoint(split):
    run = interrupted(split, epochs=3)
    train(run)
    assert run.events.filter(message="Resuming after epoch 3.").exists()
    assert list(run.epochs.values_list("epoch", flat=True)) == [1, 2, 3, 4, 5, 6, 7, 8]


def test_an_altered_checkpoint_is_not_used_and_the_log_says_so(split):
    run = interrupted(split, epochs=3)
    last = run.checkpoints.get(epoch=3)
    with (stored_folder(last.folder) / "model.safetensors").open("ab") as file:
        file.write(b"!")
    train(run)
    run.refresh_from_db()
    assert run.status == "succeeded"
    assert run.events.filter(message__contains="epoch 3 ").exists()
    assert list(run.epochs.values_list("epoch", flat=True)) == [1, 2, 3, 4, 5, 6, 7, 8]


def test_a_database_that_was_away_costs_no_run(split):
    run = claimed(split, "seq2seq", config=SHORT)

    def away(message: str) -> None:
        raise OperationalError("the connection is closed")

    train(run, tell=away)
    run.refresh_from_db()
    assert (run.status, run.failure, run.resumes) == ("queued", "", 0)
    last = run.events.last().message
    assert "database" in last and "checkpoint" in last


def test_a_disk_that_is_full_leaves_no_part_of_a_checkpoint_and_says_what_to_free(
    split, monkeypatch
):
    def full(parser: Parser, folder: Path) -> None:
        (folder / "weights").write_bytes(b"half")
        raise SafetensorError(
            "Error while serializing: I/O error: No space left on device (os error 28)"
        )

    monkeypatch.setattr(NearestNeighbour, "save", full)
    run = trained(split)
    assert run.status == "failed"
    assert "GPSR_VAR_DIR" in run.failure
    assert list(model_folder(run.pk).parent.iterdir()) == []


def test_only_the_last_and_the_best_checkpoint_stay_on_the_disk(split):
    run = trained(split, "seq2seq", config=SHORT)
    rows = {stored_folder(row.folder).name for row in run.checkpoints.all()}
    assert 1 <= len(rows) <= 2
    folder = stored_folder(run.checkpoints.first().folder).parent
    assert {path.name for path in folder.iterdir()} == rows


@pytest.mark.parametrize("name", registry.parsers())
def test_a_parser_of_the_registry_can_be_made_for_a_run_or_says_what_it_lacks(split, name):
    try:
        run = claimed(split, name, protocol=registry.entry(name).protocols[0])
    except ValueError as refusal:
        assert str(refusal) == missing_weights(registry.make_config(name, {}))
    else:
        assert isinstance(make_parser(run), Parser)
