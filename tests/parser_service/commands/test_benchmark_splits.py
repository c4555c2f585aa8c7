"""Splits that ``manage.py benchmark`` makes, and the published ones."""

from __future__ import annotations

import shutil

import pytest

from annotations.exchange.generator_import import import_generator
from parser_service.benchmarking.corpus import new_split, read_corpus, source_commands
from parser_service.management.options import read_seeds
from tests.parser_service.commands.benchmark_run import run
from tests.parser_service.made_up import made_up_pairs


def split_by_source_command(folder):
    return new_split(folder, "source_command", 0, source_commands(folder, lambda prompt: prompt))


def test_no_source_command_is_in_two_parts(folder):
    corpus = split_by_source_command(folder)
    source = {said: command for command, said, _ in made_up_pairs()}
    parts: dict[str, set[str]] = {}
    for (part, _), pairs in corpus.parts.items():
        for pair in pairs:
            parts.setdefault(source.get(pair.utterance, pair.utterance), set()).add(part)
    assert len(parts) == 36
    assert all(len(some) == 1 for some in parts.values())
    assert {part for part, _ in corpus.parts} == {"train", "validation", "test"}


def test_a_paraphrase_of_unknown_origin_is_left_out(folder):
    (folder / "paraphrasings.txt").write_text(
        "".join((folder / "paraphrasings.txt").read_text().splitlines(keepends=True)[:30])
    )
    corpus = split_by_source_command(folder)
    sources = [pair.source for pairs in corpus.parts.values() for pair in pairs]
    assert (sources.count("generated"), sources.count("paraphrased")) == (36, 10)


@pytest.mark.parametrize("criterion", ["command", "source_command", "logical_form"])
def test_new_splits_stand_in_for_the_published_one(folder, tmp_path, criterion, world):
    for name in ("gen", "para"):
        shutil.copytree(folder / name, folder / f"{name}_logical")
    options = {"criteria": criterion, "train_test": "para-para", "world": "home"}
    cells = run(folder, tmp_path / "cells.json", new_splits="2-4", **options)
    assert [(cell["split"], cell["seed"]) for cell in cells] == [(2, 0), (3, 0), (4, 0)]
    for cell in cells:
        assert (cell["n_train"], cell["n_validation"], cell["n_test"]) == pytest.approx(
            (25, 4, 7), abs=3
        )
    published = run(folder, tmp_path / "others.json", **options)
    assert [cell["split"] for cell in published] == [0 if criterion == "source_command" else None]


def test_seeds_are_so_many_or_those_of_a_range():
    assert list(read_seeds("--seeds", "3")) == [0, 1, 2]
    assert list(read_seeds("--seeds", " 6-7 ")) == [6, 7]
    assert not read_seeds("--new-splits", "0")


def test_no_form_is_in_two_parts_of_a_new_split(folder):
    for name in ("gen", "para"):
        (folder / name).rename(folder / f"{name}_logical")
    corpora = [new_split(folder, "logical_form", seed) for seed in range(2)]
    assert corpora[0] != corpora[1]
    for corpus in corpora:
        parts: dict[str, set[str]] = {}
        for (part, _), pairs in corpus.parts.items():
            for pair in pairs:
                parts.setdefault(pair.form, set()).add(part)
        assert all(len(some) == 1 for some in parts.values())


def test_the_oracle_is_right_on_every_published_generated_pair(shared_data, tmp_path, db):
    import_generator("gpsr2018", shared_data / "generator-2018")
    cells = run(
        shared_data / "walker2019",
        tmp_path / "cells.json",
        world="gpsr2018",
        parsers="grammar-oracle",
        protocols="grammar",
        criteria="command,logical_form",
        train_test="gen-gen",
    )
    assert [cell["accuracy_validation"] for cell in cells] == [1.0, 1.0]


def test_the_published_parts_have_the_published_sizes(shared_data):
    for criterion, sizes in (("command", (847, 121)), ("logical_form", (850, 129))):
        corpus = read_corpus(shared_data / "walker2019", criterion)
        parts = [corpus.pairs(part, ["generated"]) for part in ("train", "validation")]
        assert tuple(map(len, parts)) == sizes
