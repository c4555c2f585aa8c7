"""A tiny T5 and a tiny BART in a folder of encoders, and parsers that know 20 pairs by heart."""

from dataclasses import replace

import pytest

from annotations.language.forms import read_form
from annotations.language.world import infer_signatures
from parser_service.neural.t5.config import EncoderDecoderConfig
from parser_service.neural.t5.t5_parser import T5
from parser_service.parsers import pretrained_files
from tests.parser_service.neural.conftest import toy_pairs
from tests.parser_service.neural.tiny_encoder_decoder import write_bart, write_t5

SMALL = EncoderDecoderConfig(
    encoder="t5",
    steps=3,
    batch_size=10,
    learning_rate=0.01,
    label_smoothing=0.0,
    beam_width=2,
    threads=1,
)
TWENTY = toy_pairs()[:20]
UTTERANCES = [pair.utterance for pair in TWENTY]
ODD = ["", "☃", "bring " * 100, "unheard of\n\tλ"]
DECLARED = infer_signatures(
    map(read_form, [*(pair.form for pair in TWENTY), '( greet " <gesture> " )'])
)


def parser_of(seed=1, knowledge=None, **changes):
    """A parser for a training of three steps."""
    return T5(replace(SMALL, **changes), seed, knowledge)


@pytest.fixture(scope="session")
def writers(tmp_path_factory):
    """A folder of encoders as GPSR_ENCODERS_DIR names one."""
    folder = tmp_path_factory.mktemp("writers")
    write_t5(folder / "t5")
    write_bart(folder / "bart")
    return folder


@pytest.fixture
def kept_there(writers, monkeypatch):
    monkeypatch.setattr(pretrained_files, "_encoders", writers)


@pytest.fixture(scope="session", params=["t5", "bart"])
def learned(request, writers):
    """A parser of each kind of network that has seen 20 pairs often."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pretrained_files, "_encoders", writers)
        parser = parser_of(encoder=request.param, steps=70)
        parser.fit(TWENTY)
    return parser
