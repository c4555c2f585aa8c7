"""The small world of the ranker's tests, and what they look at in a parser."""

import torch

from annotations.language.forms import read_form
from annotations.language.world import Entity, Ontology, infer_signatures
from parser_service.parsers.interface import Knowledge
from tests.parser_service.neural.conftest import form, toy_pairs

UNSEEN = form("find", "object", " in the <location>")
HOME = Ontology(
    (
        Entity("object", "apple"),
        Entity("object", "jam"),
        Entity("room", "kitchen"),
        Entity("location", "sink"),
        Entity("name", "Ann"),
    )
)


def domain() -> Knowledge:
    forms = [read_form(pair.form) for pair in toy_pairs()]
    return Knowledge(infer_signatures(forms), HOME)


def weights(parser):
    return parser._model.state_dict()


def same_weights(one, other):
    return all(torch.equal(value, weights(other)[name]) for name, value in weights(one).items())


def utterances(pairs):
    return [pair.utterance for pair in pairs]
