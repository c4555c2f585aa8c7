"""A parser of one's own is a module, a registry line and a test: this is all of it (docs/design/parsers.md)."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace

import pytest

from parser_service.parsers import registry
from parser_service.parsers.interface import Candidate, Parser
from parser_service.parsers.storage import open_sealed, read_json, seal, write_json
from tests.parser_service.made_up import make_split
from tests.parser_service.runs.test_train_run import trained


@dataclass(frozen=True)
class MostFrequentConfig:
    pass


class MostFrequent(Parser):
    """Answers the most frequent form of training, whatever one says."""

    name, version, protocols, Config = "most-frequent", 1, ("strict",), MostFrequentConfig

    def fit(self, train, validation=(), observe=None):
        self.form = Counter(pair.form for pair in train).most_common(1)[0][0]

    def predict(self, utterances, beam_width=1, check=lambda: None):
        return [[Candidate(self.form, 1.0)] for _ in utterances]

    def save(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        write_json(folder / "form.json", self.form)
        seal(folder, self, ["form.json"])

    @classmethod
    def load(cls, folder, knowledge=None):
        saved = open_sealed(folder, cls, ["form.json"])
        parser = cls(saved.config, saved.seed, knowledge)
        parser.form = read_json(folder / "form.json")
        return parser

    def parameters(self):
        return 0


@pytest.fixture
def registered(monkeypatch):
    entry = registry.RegistryEntry(
        dotted=f"{__name__}.MostFrequent",
        config=f"{__name__}.MostFrequentConfig",
        title="Most frequent",
        description="Answers the most frequent form of training.",
        version=1,
        protocols=("strict",),
    )
    monkeypatch.setitem(registry.parsers(), "most-frequent", entry)


def test_a_parser_that_is_registered_trains_and_is_scored(registered, world, transactional_db):
    run = trained(make_split(world), "most-frequent")
    assert (run.status, run.failure) == ("succeeded", "")
    assert {each.test_source for each in run.evaluations.all()} >= {"gen"}


def test_what_it_did_not_read_to_the_end_is_said(registered, world, transactional_db, monkeypatch):
    read = MostFrequent.predict
    monkeypatch.setattr(
        MostFrequent,
        "predict",
        lambda self, utterances, *_: [
            [replace(answer, is_cut=len(text) > 30) for answer in answers]
            for text, answers in zip(utterances, read(self, utterances), strict=True)
        ],
    )
    split = make_split(world)
    long = split.examples.filter(part="test").first()
    long.utterance = "bring me whatever there is, wherever it may be"
    long.save()
    run = trained(split, "most-frequent")
    cut = run.predictions.filter(is_cut=True)
    assert {row.example for row in cut} == set(
        split.examples.filter(utterance__length__gt=30).exclude(part="train")
    )
    assert run.events.filter(message__contains="longer than the parser reads").count() == 1
