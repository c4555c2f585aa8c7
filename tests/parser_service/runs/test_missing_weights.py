"""A parser whose pretrained weights are not there says so wherever it can be asked for."""

from __future__ import annotations

import re
from html import unescape
from io import StringIO

import pytest
from django.conf import settings
from django.core.management import CommandError, call_command

from annotations.language.corpus import by_length, write_pairs
from annotations.language.texts.errors import Refusal
from parser_service.models import TrainingRun
from parser_service.parsers import pretrained_files
from parser_service.parsers.pretrained_files import missing_weights
from parser_service.parsers.registry import config_fields, make_config
from parser_service.runs import run_requests
from tests.parser_service.made_up import made_up_pairs
from tests.sample_world import fill_world

PARSER = "seq2seq-glove-elmo"
NEEDED = ("glove.6B.100d.txt", "elmo_2x4096_512_2048cnn_2xhighway_weights.hdf5")


@pytest.fixture
def sentence(tmp_path, monkeypatch) -> str:
    """What the parser lacks where the folder of encoders is empty: everything."""
    monkeypatch.setattr(pretrained_files, "_encoders", tmp_path / "encoders")
    sentence = missing_weights(make_config(PARSER))
    assert all(name in sentence for name in (*NEEDED, str(tmp_path / "encoders")))
    return sentence


def test_the_installation_says_where_its_encoders_are():
    assert pretrained_files.encoders_folder() == settings.ENCODERS_DIR
    assert pretrained_files.vectors_folder() == settings.VAR_DIR / "vectors"


def test_the_page_says_it_before_anything_is_filled_in(world, adam, sentence):
    fill_world(world)
    page = adam.get("/w/home/runs/new/", {"parser": PARSER}).content.decode()
    assert sentence in unescape(page)


def test_the_page_refuses_the_run_with_it(world, adam, sentence):
    values = {f"config-{each.name}": each.default for each in config_fields(PARSER)}
    asked = {"split": fill_world(world).split.pk, "train_sources": "para", "seed": 7}
    posted = {**asked, "protocol": "strict", **values}
    before = TrainingRun.objects.count()
    page = adam.post(f"/w/home/runs/new/?parser={PARSER}", posted).content.decode()
    assert sentence in unescape(page)
    assert TrainingRun.objects.count() == before


@pytest.mark.parametrize(
    "parser, field", [(PARSER, "glove"), (PARSER, "elmo"), ("ranker", "encoder")]
)
def test_a_name_that_no_file_can_have_is_missing_and_none_at_all_is_refused(parser, field):
    assert field in missing_weights(make_config(parser, {field: 1000 * "x"}))
    with pytest.raises(Refusal, match=rf"\b{field}\b") as refused:
        make_config(parser, {field: " "})
    assert refused.value.code == "hyperparameter_missing"


def test_a_run_is_not_queued(world, split, sentence):
    with pytest.raises(Refusal) as refused:
        run_requests.request(world, split, PARSER)
    assert refused.value.code == "requirement_missing"
    assert str(refused.value) == sentence


@pytest.mark.parametrize("there", ["config.json", "nothing"])
def test_neither_page_nor_request_tells_of_files_elsewhere(world, adam, split, tmp_path, there):
    (tmp_path / there).touch()
    named = f"encoder is {str(tmp_path)!r}"
    with pytest.raises(Refusal, match=f"{re.escape(named)}.*GPSR_ENCODERS_DIR") as refused:
        run_requests.request(world, split, "ranker", {"encoder": str(tmp_path)})
    assert refused.value.code == "requirement_missing"
    values = {f"config-{each.name}": each.default for each in config_fields("ranker")}
    asked = {"split": split.pk, "train_sources": "gen", "protocol": "strict", "seed": 0, "seeds": 1}
    posted = {**values, **asked, "config-encoder": str(tmp_path)}
    page = unescape(adam.post("/w/home/runs/new/?parser=ranker", posted).content.decode())
    assert named in page
    of_it, _, _ = page[page.index(named) :].partition("<")
    assert "config.json" not in of_it  # what other parsers lack is listed, too
    assert not TrainingRun.objects.exists()


def test_the_command_line_may_name_any_path(world, split, tmp_path):
    (tmp_path / "words.txt").touch()
    config = {"glove": str(tmp_path / "words.txt")}
    run, _ = run_requests.request(world, split, "seq2seq-glove", config, send=False, anywhere=True)
    assert run.config["glove"] == config["glove"]


def test_the_train_command_refuses_with_it(split, sentence):
    with pytest.raises(CommandError) as refused:
        call_command("train", PARSER, world="home", split="home", stderr=StringIO())
    assert str(refused.value) == sentence


def test_the_benchmark_says_it_and_measures_the_others(tmp_path, sentence):
    rows = by_length([(command, form) for command, _, form in made_up_pairs()])
    for file in ("train.txt", "val.txt"):
        path = tmp_path / "pairs" / "gen" / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("".join(write_pairs(rows)), encoding="utf-8")
    file = tmp_path / "cells.json"
    asked = {"train_test": "gen-gen", "criteria": "command", "protocols": "strict"}
    with pytest.raises(CommandError) as refused:
        call_command(
            "benchmark", str(tmp_path / "pairs"), parsers=f"{PARSER},knn", json=file, **asked
        )
    assert str(refused.value) == f"{PARSER}, strict: {sentence}"
    assert '"parser": "knn"' in file.read_text(encoding="utf-8")
