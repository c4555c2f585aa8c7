"""What a parser learns from and is tested on, by name."""

from __future__ import annotations

import pytest

from annotations.language.texts.errors import Refusal
from annotations.models.splits import Source
from parser_service.models import Evaluation, TrainingRun
from parser_service.parsers.conditions import (
    PAPERS_SETTINGS,
    SETTINGS,
    SOURCES,
    TEST_SOURCES,
    TRAIN_SOURCES,
    Setting,
    in_words,
    settings_of,
    sources_of,
    written_sources,
)


def test_every_source_of_examples_has_a_name():
    assert set(SOURCES.values()) == set(Source.values)


def test_every_combination_is_there_once_and_the_papers_come_first():
    assert TRAIN_SOURCES[:3] == ("gen", "para", "gen+para")
    assert len(TRAIN_SOURCES) == len(set(TRAIN_SOURCES)) == 2 ** len(SOURCES) - 1
    assert all(written_sources(sources_of(each)) == each for each in TRAIN_SOURCES)
    assert len({in_words(each) for each in TRAIN_SOURCES}) == len(TRAIN_SOURCES)


def test_settings_are_read_as_they_are_written():
    assert [Setting.read(str(each)) for each in SETTINGS] == list(SETTINGS)
    assert [str(each) for each in PAPERS_SETTINGS] == [
        *("gen-gen", "gen-para", "para-para", "gen+para-para", "gen+para-mixed")
    ]
    assert {each.test_source for each in SETTINGS} == set(TEST_SOURCES)
    with pytest.raises(Refusal) as refused:
        Setting.read("para+gen-para")
    assert refused.value.code == "unknown_setting"


def test_names_fit_into_their_columns():
    for model, column, names in (
        (TrainingRun, "train_sources", TRAIN_SOURCES),
        (Evaluation, "test_source", TEST_SOURCES),
    ):
        assert max(map(len, names)) <= model._meta.get_field(column).max_length


def test_what_is_trained_on_is_tested_on_what_people_say_too():
    for each in TRAIN_SOURCES:
        assert {"para", "said", "model"} <= {setting.test_source for setting in settings_of(each)}
