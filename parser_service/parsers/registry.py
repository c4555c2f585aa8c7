"""The parsers by name. It holds paths, not classes: importing it loads neither torch nor a parser."""

from __future__ import annotations

import gc
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from enum import StrEnum
from importlib import import_module
from typing import Any

from annotations.language.texts import Refusal
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.hyperparameters.fields import ConfigField, describe, read_config
from parser_service.parsers.interface import Parser


class Needs(StrEnum):
    """What a parser needs most before it can be trained."""

    NOTHING = "nothing"
    CPU = "minutes on a CPU"
    GPU = "a GPU recommended"
    WEIGHTS = "weights to bring"
    SERVER = "a server to ask"


@dataclass(frozen=True, slots=True)
class RegistryEntry:
    """One parser as pages, the worker and the command line see it.

    ``in_short`` says in one plain sentence what it does, ``description`` how.

    ``dotted`` is the path of its class (which may import torch), ``config`` of its hyperparameters
    (which may not); ``queue`` names the workers that may run it: ``quick`` where training takes seconds and
    needs no torch, otherwise ``cpu`` or ``gpu``. ``loss_unit`` is that of the losses it reports.
    ``learns`` is False where training pairs change nothing, ``writes_new_forms`` where it never answers with a
    form that no training pair has.
    ``may_know_corpora`` marks figures of a model that may have read a public corpus, test part and all,
    before anybody trained it here. ``most_subwords`` is how many it reads of an utterance, 0 where it reads
    all or where that is up to its weights.
    """

    dotted: str
    config: str
    title: str
    description: str
    version: int
    protocols: tuple[Protocol, ...]
    in_short: str = ""
    needs: Needs = Needs.CPU
    queue: str = "cpu"
    loss_unit: str = "nats a token"
    learns: bool = True
    writes_new_forms: bool = True
    may_know_corpora: bool = False
    most_subwords: int = 0


ORACLE = "grammar-oracle"
PARSERS: dict[str, RegistryEntry] = {
    ORACLE: RegistryEntry(
        dotted="parser_service.parsers.oracle.GrammarOracle",
        config="parser_service.parsers.oracle.OracleConfig",
        title="Grammar oracle",
        description="Chart-parses with the annotated grammar and returns the template's form. "
        "Learns nothing; has no answer outside the grammar.",
        version=6,
        protocols=(Protocol.GRAMMAR,),
        in_short="Reads a command of the annotated grammar; answers without a run. A run is for comparison alone.",
        needs=Needs.NOTHING,
        queue="quick",
        learns=False,
    ),
    "knn": RegistryEntry(
        dotted="parser_service.parsers.knn.NearestNeighbour",
        config="parser_service.parsers.knn.NearestNeighbourConfig",
        title="Nearest neighbour",
        description="Returns the form of the training utterance that shares the most words "
        "(Jaccard distance). Never answers with a form it has not seen.",
        version=1,
        protocols=(Protocol.STRICT,),
        in_short="Answers as for the most similar training utterance.",
        needs=Needs.NOTHING,
        queue="quick",
        writes_new_forms=False,
    ),
    "linear": RegistryEntry(
        dotted="parser_service.parsers.linear.LinearClassifier",
        config="parser_service.parsers.hyperparameters.linear.LinearConfig",
        title="Linear classifier",
        description="A logistic regression for each form of the training pairs, over the TF-IDF of words and "
        "of parts of words. Never answers with a form it has not seen.",
        version=1,
        protocols=(Protocol.STRICT, Protocol.DOMAIN),
        in_short="Learns which words speak for which form, in seconds; good on new wording of known forms.",
        needs=Needs.NOTHING,
        queue="quick",
        writes_new_forms=False,
    ),
    "seq2seq": RegistryEntry(
        dotted="parser_service.neural.seq2seq.seq2seq_parser.Seq2Seq",
        config="parser_service.parsers.hyperparameters.seq2seq.Seq2SeqConfig",
        title="Sequence to sequence",
        description="Bidirectional LSTM encoder, bilinear attention, LSTM decoder, beam search; "
        "word vectors learned from the training pairs alone.",
        version=1,
        protocols=(Protocol.STRICT,),
        in_short="A small neural network that writes the form word by word; the paper's baseline.",
    ),
    "seq2seq-glove": RegistryEntry(
        dotted="parser_service.neural.seq2seq.rows.Seq2SeqGlove",
        config="parser_service.parsers.hyperparameters.vectors.GloveConfig",
        title="Seq2seq + GloVe",
        description="Sequence to sequence with word vectors that start as GloVe's and are "
        "trained further.",
        version=1,
        protocols=(Protocol.STRICT,),
        in_short="The same network with GloVe word vectors.",
        needs=Needs.WEIGHTS,
    ),
    "seq2seq-glove-elmo": RegistryEntry(
        dotted="parser_service.neural.seq2seq.rows.Seq2SeqGloveElmo",
        config="parser_service.parsers.hyperparameters.vectors.GloveElmoConfig",
        title="Seq2seq + GloVe, ELMo",
        description="Sequence to sequence with GloVe and, frozen, the layers of ELMo under a "
        "learned mix.",
        version=1,
        protocols=(Protocol.STRICT,),
        in_short="The same network with GloVe and ELMo; the first pass over the texts is slow on a CPU.",
        needs=Needs.WEIGHTS,
    ),
    "seq2seq-glove-gpt": RegistryEntry(
        dotted="parser_service.neural.seq2seq.rows.Seq2SeqGloveGpt",
        config="parser_service.parsers.hyperparameters.vectors.GloveGptConfig",
        title="Seq2seq + GloVe, GPT",
        description="Sequence to sequence with GloVe and, frozen, the last layer of OpenAI's GPT.",
        version=1,
        protocols=(Protocol.STRICT,),
        in_short="The same network with GloVe and OpenAI's first GPT.",
        needs=Needs.WEIGHTS,
    ),
    "seq2seq-glove-bert-base": RegistryEntry(
        dotted="parser_service.neural.seq2seq.rows.Seq2SeqGloveBertBase",
        config="parser_service.parsers.hyperparameters.vectors.GloveBertBaseConfig",
        title="Seq2seq + GloVe, BERT base",
        description="Sequence to sequence with GloVe and, frozen, the last layer of BERT base.",
        version=1,
        protocols=(Protocol.STRICT,),
        in_short="The same network with GloVe and BERT base.",
        needs=Needs.WEIGHTS,
    ),
    "seq2seq-glove-bert-large": RegistryEntry(
        dotted="parser_service.neural.seq2seq.rows.Seq2SeqGloveBertLarge",
        config="parser_service.parsers.hyperparameters.vectors.GloveBertLargeConfig",
        title="Seq2seq + GloVe, BERT large",
        description="Sequence to sequence with GloVe and, frozen, the last layer of BERT large.",
        version=1,
        protocols=(Protocol.STRICT,),
        in_short="The same network with GloVe and BERT large; a GPU is recommended.",
        needs=Needs.WEIGHTS,
    ),
    "seq2seq-minilm": RegistryEntry(
        dotted="parser_service.neural.seq2seq.rows.Seq2SeqMiniLm",
        config="parser_service.parsers.hyperparameters.vectors.MiniLmConfig",
        title="Seq2seq + MiniLM",
        description="Sequence to sequence with learned word vectors and, frozen, the last layer of "
        "a small sentence encoder.",
        version=1,
        protocols=(Protocol.STRICT,),
        in_short="The small network with a sentence encoder that comes with this installation.",
    ),
    "ranker": RegistryEntry(
        dotted="parser_service.neural.ranker.form_ranker.FormRanker",
        config="parser_service.parsers.hyperparameters.ranker.RankerConfig",
        title="Form ranker",
        description="A fine-tuned sentence encoder chooses among whole forms, by their examples and "
        "by their English glosses; new forms, made from those of the training pairs, are among them.",
        version=13,
        protocols=(Protocol.STRICT, Protocol.DOMAIN, Protocol.GRAMMAR),
        in_short="Chooses the form that fits best among known and new ones; needs few pairs of each form.",
        loss_unit="nats an utterance",
        most_subwords=64,
    ),
    "t5": RegistryEntry(
        dotted="parser_service.neural.t5.t5_parser.T5",
        config="parser_service.parsers.hyperparameters.t5.EncoderDecoderConfig",
        title="Encoder–decoder (T5, BART)",
        description="Fine-tunes a pretrained encoder–decoder to write forms; what it may write is "
        "free, one of a list of forms, or whatever the signatures of predicates allow.",
        version=1,
        protocols=(Protocol.STRICT, Protocol.DOMAIN),
        in_short="Fine-tunes a T5 or BART that you bring to write the form; a GPU is recommended.",
        needs=Needs.WEIGHTS,
    ),
    "llm": RegistryEntry(
        dotted="parser_service.parsers.llm.language_model.LanguageModel",
        config="parser_service.parsers.llm.config.LanguageModelConfig",
        title="Language model",
        description="Asks a language model over HTTP, with the nearest training pairs as examples. It "
        "chooses among their forms, action by action where these are sequences, or writes one; it learns "
        "nothing here.",
        version=2,
        protocols=(Protocol.STRICT, Protocol.DOMAIN),
        in_short="Shows the most similar training utterances to a language model on a server of yours.",
        needs=Needs.SERVER,
        may_know_corpora=True,
    ),
}


def entry(name: str) -> RegistryEntry:
    """Return the entry called ``name``. Raises Refusal with the names there are."""
    if name not in PARSERS:
        raise Refusal(
            f"No parser is called {name!r}; there are: {', '.join(PARSERS)}.", "unknown_parser"
        )
    return PARSERS[name]


def title_of(parser: str) -> str:
    """Return what pages call a parser; its name where the registry no longer has it."""
    return PARSERS[parser].title if parser in PARSERS else parser


def untrained() -> list[str]:
    """Return the names of the parsers that training pairs change nothing of: they answer without a run."""
    return [name for name, each in PARSERS.items() if not each.learns]


def needing(needs: Needs) -> list[str]:
    """Return the names of the parsers that need this most."""
    return [name for name, each in PARSERS.items() if each.needs is needs]


def load_class(name: str) -> type[Parser]:
    """Import the class of a parser, and torch where it needs that: for workers, not for pages."""
    # Importing torch makes hundreds of thousands of objects that stay; to look through them for garbage
    # again and again takes time.
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        parser: type[Parser] = _attribute(entry(name).dotted)
    finally:
        if was_enabled:
            gc.enable()
    return parser


def config_class(name: str) -> type:
    """Import the config dataclass of a parser; never loads torch."""
    config: type = _attribute(entry(name).config)
    return config


def config_fields(name: str) -> tuple[ConfigField, ...]:
    """Return the hyperparameters of a parser with their defaults, bounds and descriptions."""
    return describe(config_class(name))


def make_config(name: str, values: Mapping[str, Any] | None = None) -> Any:
    """Make a validated config from JSON ``values``. Raises Refusal."""
    return read_config(config_class(name), values or {})


def config_values(config: Any) -> dict[str, Any]:
    """Return a config as JSON with every field: what is stored with the run and hashed."""
    return asdict(config)


def _attribute(dotted: str) -> Any:
    module, _, name = dotted.rpartition(".")
    return getattr(import_module(module), name)
