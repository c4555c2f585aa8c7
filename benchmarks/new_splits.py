"""The ranker on new splits of the published pairs by source command."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fresh_site import DATA, WORLD

if TYPE_CHECKING:  # the project is importable only once a site was entered
    from parser_service.corpus import Corpus
    from parser_service.parsers.interface import Parser

SETTINGS = ("para-para", "gen+para-para")
PROTOCOL, CRITERION = "domain", "source_command"


def trained(split: int, setting: str) -> tuple[Parser, Corpus]:
    """(parser, corpus): the ranker (domain, seed 0) trained on the train pairs of a new split and
    calibrated on its validation pairs, and the parts of that split. Takes a few minutes."""
    from annotations.models import World
    from parser_service.knowledge import knowledge_of
    from parser_service.management.commands.benchmark import corpus_of
    from parser_service.models.runs import TrainSources
    from parser_service.parsers.registry import load_class, make_config

    world = World.objects.get(name=WORLD)
    corpus = corpus_of(DATA / "walker2019", CRITERION, split, world)
    sources = TrainSources(setting.rpartition("-")[0]).sources
    knowledge = knowledge_of(world, PROTOCOL).limited_to(PROTOCOL)
    parser = load_class("ranker")(make_config("ranker"), 0, knowledge)
    parser.fit(corpus.pairs("train", sources), corpus.pairs("validation", sources))
    return parser, corpus
