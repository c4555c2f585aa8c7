"""The generated commands behind the published paraphrases."""

from __future__ import annotations

import pytest

from annotations.exchange.generator_import import import_generator
from annotations.generation.generating import generate_pairs
from annotations.language.corpus import Criterion
from annotations.models import World
from parser_service.benchmarking.corpus import Corpus, new_split, read_corpus, source_commands
from parser_service.benchmarking.missing_cells import load_corpus
from parser_service.benchmarking.paraphrase_sources import find_sources
from parser_service.runs.knowledge import anonymizer_of
from tests.parser_service.made_up import make_folder

BOTH = ("generated", "paraphrased")


@pytest.fixture
def gpsr2018(db, shared_data):
    import_generator("gpsr2018", shared_data / "generator-2018")
    return World.objects.get(name="gpsr2018")


@pytest.fixture
def published(shared_data):
    return shared_data / "walker2019"


def leaks(corpus: Corpus, part: str) -> int:
    """The paraphrases of a part whose source command is in training, as itself or by a paraphrase."""
    trained = {corpus.cluster(pair) for pair in corpus.pairs("train", BOTH)}
    return sum(corpus.cluster(pair) in trained for pair in corpus.pairs(part, ["paraphrased"]))


@pytest.mark.parametrize("seed", [0, 14])
def test_no_paraphrase_is_tested_whose_command_is_in_training(gpsr2018, published, seed):
    corpus = load_corpus(published, "source_command", seed, gpsr2018)
    assert [leaks(corpus, part) for part in ("validation", "test")] == [0, 0]


def test_anonymized_prompts_alone_would_leak(gpsr2018, published):
    sources = find_sources(published, gpsr2018)
    by_prompt = source_commands(published, anonymizer_of(gpsr2018))
    split = new_split(published, "source_command", 0, by_prompt)
    corpus = Corpus(split.criterion, split.parts, sources.source_of)
    assert [leaks(corpus, part) for part in ("validation", "test")] == [1, 23]


def test_what_has_no_command_is_told_and_goes_to_training(gpsr2018, published):
    sources = find_sources(published, gpsr2018)
    assert (len(sources.source_of), len(sources.unresolved)) == (1300, 21)
    assert sources.sentence.startswith("21 of 1300 paraphrases ")
    corpus = load_corpus(published, "source_command", 0, gpsr2018, sources)
    for part in ("validation", "test"):
        said = {pair.utterance for pair in corpus.pairs(part, ["paraphrased"])}
        assert said.isdisjoint(sources.unresolved)
    pool = read_corpus(published, "command")
    of_pool = {pair.utterance for part, _ in pool.parts for pair in pool.pairs(part, BOTH[1:])}
    trained = {pair.utterance for pair in corpus.pairs("train", ["paraphrased"])}
    assert of_pool & sources.unresolved == trained & sources.unresolved != set()


def test_stored_commands_and_those_of_the_templates_resolve_alike(gpsr2018, published):
    before = find_sources(published, gpsr2018)
    generate_pairs(gpsr2018)
    assert find_sources(published, gpsr2018) == before


def test_the_known_part_of_the_published_split_by_form(gpsr2018, published):
    corpus = load_corpus(published, "logical_form", None, gpsr2018)
    with_known = corpus.with_known(0)
    known, train = (with_known.pairs(part, BOTH) for part in ("known", "train"))
    assert sorted([*known, *train], key=str) == sorted(corpus.pairs("train", BOTH), key=str)
    assert {pair.form for pair in train} == {pair.form for pair in corpus.pairs("train", BOTH)}
    assert 100 < len(with_known.pairs("known", ["paraphrased"])) < 130
    sources = [
        {corpus.item(pair).key(Criterion.SOURCE_COMMAND) for pair in each}
        for each in (known, train)
    ]
    assert sources[0].isdisjoint(sources[1])
    assert with_known.parts == corpus.with_known(0).parts != corpus.with_known(1).parts


def test_without_a_world_prompts_stand_for_themselves(tmp_path):
    sources = find_sources(make_folder(tmp_path), None)
    assert not sources.sentence
    assert sources.source_of["please fetch the <object> now"] == "bring me the <object>"
