"""The parsers there are. Paths, not classes: reading this file loads neither torch nor a parser."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from importlib import import_module
from typing import Any

from parser_service.parsers.config_fields import ConfigField, describe, read_config
from parser_service.parsers.interface import Parser, Protocol


@dataclass(frozen=True, slots=True)
class Entry:
    """One parser as pages, the worker and the command line see it.

    ``dotted`` is the path of its class (which may import torch), ``config`` of its hyperparameters
    (which may not); ``queue`` names the workers that may run it, ``cpu`` or ``gpu``. ``loss_unit`` is
    that of the losses it reports.
    """

    dotted: str
    config: str
    title: str
    description: str
    version: int
    protocols: tuple[Protocol, ...]
    queue: str = "cpu"
    loss_unit: str = "nats a token"


PARSERS: dict[str, Entry] = {
    "grammar-oracle": Entry(
        dotted="parser_service.parsers.oracle.GrammarOracle",
        config="parser_service.parsers.oracle.OracleConfig",
        title="Grammar oracle",
        description="Chart-parses with the annotated grammar and returns the template's form. "
        "Learns nothing; has no answer outside the grammar.",
        version=2,
        protocols=("grammar",),
    ),
    "knn": Entry(
        dotted="parser_service.parsers.knn.NearestNeighbour",
        config="parser_service.parsers.knn.NearestNeighbourConfig",
        title="Nearest neighbour",
        description="Returns the form of the training utterance that shares most words "
        "(Jaccard distance). Never answers a form it has not seen.",
        version=1,
        protocols=("strict",),
    ),
    "seq2seq": Entry(
        dotted="parser_service.neural.seq2seq.Seq2Seq",
        config="parser_service.parsers.seq2seq_config.Seq2SeqConfig",
        title="Sequence to sequence",
        description="Bidirectional LSTM encoder, bilinear attention, LSTM decoder, beam search; "
        "word vectors learned from the training pairs alone.",
        version=1,
        protocols=("strict",),
    ),
    "seq2seq-glove": Entry(
        dotted="parser_service.neural.seq2seq_vectors.Seq2SeqGlove",
        config="parser_service.parsers.vectors_config.GloveConfig",
        title="Seq2seq + GloVe",
        description="Sequence to sequence with word vectors that start as GloVe's and are trained "
        "on.",
        version=1,
        protocols=("strict",),
    ),
    "seq2seq-glove-elmo": Entry(
        dotted="parser_service.neural.seq2seq_vectors.Seq2SeqGloveElmo",
        config="parser_service.parsers.vectors_config.GloveElmoConfig",
        title="Seq2seq + GloVe, ELMo",
        description="Sequence to sequence with GloVe and, frozen, the layers of ELMo under a "
        "learned mix.",
        version=1,
        protocols=("strict",),
    ),
    "seq2seq-glove-gpt": Entry(
        dotted="parser_service.neural.seq2seq_vectors.Seq2SeqGloveGpt",
        config="parser_service.parsers.vectors_config.GloveGptConfig",
        title="Seq2seq + GloVe, GPT",
        description="Sequence to sequence with GloVe and, frozen, the last layer of OpenAI's GPT.",
        version=1,
        protocols=("strict",),
    ),
    "seq2seq-glove-bert-base": Entry(
        dotted="parser_service.neural.seq2seq_vectors.Seq2SeqGloveBertBase",
        config="parser_service.parsers.vectors_config.GloveBertBaseConfig",
        title="Seq2seq + GloVe, BERT base",
        description="Sequence to sequence with GloVe and, frozen, the last layer of BERT base.",
        version=1,
        protocols=("strict",),
    ),
    "seq2seq-glove-bert-large": Entry(
        dotted="parser_service.neural.seq2seq_vectors.Seq2SeqGloveBertLarge",
        config="parser_service.parsers.vectors_config.GloveBertLargeConfig",
        title="Seq2seq + GloVe, BERT large",
        description="Sequence to sequence with GloVe and, frozen, the last layer of BERT large.",
        version=1,
        protocols=("strict",),
    ),
    "seq2seq-minilm": Entry(
        dotted="parser_service.neural.seq2seq_vectors.Seq2SeqMiniLm",
        config="parser_service.parsers.vectors_config.MiniLmConfig",
        title="Seq2seq + MiniLM",
        description="Sequence to sequence with learned word vectors and, frozen, the last layer of "
        "a small sentence encoder.",
        version=1,
        protocols=("strict",),
    ),
    "ranker": Entry(
        dotted="parser_service.neural.ranker.FormRanker",
        config="parser_service.parsers.ranker_config.RankerConfig",
        title="Form ranker",
        description="A fine-tuned sentence encoder chooses among whole forms, by their examples and "
        "by their English glosses; also among new forms, made from those of the training pairs.",
        version=6,
        protocols=("strict", "domain", "grammar"),
        loss_unit="nats an utterance",
    ),
}


def entry(name: str) -> Entry:
    """The entry called ``name``. Raises ValueError naming those there are."""
    if name not in PARSERS:
        raise ValueError(f"No parser is called {name!r}; there are: {', '.join(PARSERS)}.")
    return PARSERS[name]


def load_class(name: str) -> type[Parser]:
    """The class of a parser. Loads torch where the parser needs it: for workers, not for pages."""
    parser: type[Parser] = _attribute(entry(name).dotted)
    return parser


def config_class(name: str) -> type:
    """The config dataclass of a parser; never loads torch."""
    found: type = _attribute(entry(name).config)
    return found


def config_fields(name: str) -> tuple[ConfigField, ...]:
    """The hyperparameters of a parser with their defaults, bounds and descriptions."""
    return describe(config_class(name))


def make_config(name: str, values: Mapping[str, Any] | None = None) -> Any:
    """A validated config from JSON ``values``. Raises ValueError, a sentence."""
    return read_config(config_class(name), values or {})


def config_values(config: Any) -> dict[str, Any]:
    """A config as JSON, every field named: what is stored with the run and hashed."""
    return asdict(config)


def _attribute(dotted: str) -> Any:
    module, _, name = dotted.rpartition(".")
    return getattr(import_module(module), name)
