"""A tiny encoder, and a ranker that has learned with it."""

from dataclasses import replace

import pytest

from parser_service.neural.ranker.form_ranker import FormRanker
from parser_service.neural.ranker.ranked_forms import glosses
from parser_service.parsers.hyperparameters.ranker import RankerConfig
from tests.parser_service.neural.conftest import toy_pairs
from tests.parser_service.neural.ranker.sample_domain import UNSEEN
from tests.parser_service.neural.tiny_encoder import write_tiny_encoder

EXTRA = "bring find is_a name at with given from apple jam kitchen sink Ann who one that is"


@pytest.fixture(scope="session")
def config(tmp_path_factory):
    said = {pair.utterance for pair in toy_pairs()} | {pair.form for pair in toy_pairs()} | {EXTRA}
    folder = tmp_path_factory.mktemp("encoders") / "tiny"
    forms = sorted({pair.form for pair in toy_pairs()})
    words = {piece for text in [*said, *glosses(forms, None)] for piece in text.split()}
    write_tiny_encoder(folder, words | {"object", "room", "location", "<", ">", ",", "look"})
    return RankerConfig(
        encoder=str(folder),
        steps=30,
        batch_size=8,
        learning_rate=1e-3,
        head_learning_rate=5e-2,
        averaging=0.9,
        pretrained_share=0.0,
        pretrained_share_domain=0.0,
        rewordings=0,
        threads=1,
    )


@pytest.fixture(scope="session")
def learned(config, pairs):
    """A ranker that has seen every pair but those of one form."""
    parser = FormRanker(replace(config, steps=150), seed=1)
    parser.fit([pair for pair in pairs if pair.form != UNSEEN], pairs)
    return parser
