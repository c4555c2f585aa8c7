"""The parsers by name: those that come with this package, and those that installed packages register.

It holds paths, not classes: asking it loads neither torch nor a parser.
"""

from __future__ import annotations

import gc
import logging
from collections.abc import Mapping
from dataclasses import asdict
from functools import cache
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from annotations.language.texts import Refusal
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.hyperparameters.fields import ConfigField, describe, read_config
from parser_service.parsers.interface import Parser
from parser_service.parsers.registry_entry import QUEUES, Expectation, Needs, RegistryEntry

logger = logging.getLogger(__name__)

GROUP = "gpsr_workbench.parsers"  # of entry points: each names a dict like this one
ORACLE = "grammar-oracle"
SHIPPED: dict[str, RegistryEntry] = {
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
        expected=Expectation(1.0, 0.07, time="no training"),
        published={
            ("gen", "gen"): (100.0, 100.0),
            ("gen", "para"): (1.1, 0.9),
            ("para", "para"): (1.1, 0.9),
            ("gen+para", "para"): (1.1, 0.9),
        },
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
        expected=Expectation(time="a second"),
        published={
            ("gen", "gen"): (63.0, 0.0),
            ("gen", "para"): (42.0, 0.0),
            ("para", "para"): (42.8, 0.0),
            ("gen+para", "para"): (49.8, 0.0),
        },
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
        expected=Expectation(time="seconds", memory="0.5 GB"),
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
        expected=Expectation(time="minutes on 1 core", memory="0.4 GB"),
        published={
            ("gen", "gen"): (95.9, 0.0),
            ("gen", "para"): (13.0, 0.0),
            ("para", "para"): (64.4, 0.0),
            ("gen+para", "para"): (79.6, 0.0),
        },
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
        expected=Expectation(time="minutes on 1 core", memory="0.4 GB"),
        published={
            ("gen", "gen"): (98.8, 26.3),
            ("gen", "para"): (12.4, 0.0),
            ("para", "para"): (70.2, 0.0),
            ("gen+para", "para"): (85.3, 6.3),
        },
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
        published={
            ("gen", "gen"): (96.3, 56.9),
            ("gen", "para"): (12.2, 3.3),
            ("para", "para"): (75.4, 31.3),
            ("gen+para", "para"): (87.6, 37.6),
        },
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
        published={
            ("gen", "gen"): (97.9, 54.7),
            ("gen", "para"): (27.1, 9.6),
            ("para", "para"): (78.5, 30.4),
            ("gen+para", "para"): (89.4, 37.6),
        },
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
        expected=Expectation(time="a minute on 1 core", memory="0.6 GB"),
    ),
    "ranker": RegistryEntry(
        dotted="parser_service.neural.ranker.form_ranker.FormRanker",
        config="parser_service.parsers.hyperparameters.ranker.RankerConfig",
        title="Form ranker",
        description="A fine-tuned sentence encoder chooses among whole forms, by their examples and "
        "by their English glosses; new forms, made from those of the training pairs, are among them.",
        version=14,
        protocols=(Protocol.STRICT, Protocol.DOMAIN, Protocol.GRAMMAR),
        in_short="Chooses the form that fits best among known and new ones; needs few pairs of each form.",
        loss_unit="nats an utterance",
        most_subwords=64,
        expected=Expectation(time="minutes on 2 cores", memory="2 GB"),
    ),
}


def _registered() -> dict[str, RegistryEntry]:
    """Return the parsers that installed packages register. Those of a package that cannot be read are left out, and
    the log says so: all others go on."""
    added: dict[str, RegistryEntry] = {}
    for point in sorted(entry_points(group=GROUP), key=lambda each: (_package_of(each), each.name)):
        try:
            entries = dict(point.load())
            for name, each in entries.items():
                _check(name, each, {**SHIPPED, **added})
        except Exception as error:  # whatever the code of others raises
            logger.warning(
                "The parsers that the package %s registers as %s cannot be used: %s. All others go on.",
                _package_of(point),
                point.value,
                error,
            )
        else:
            added |= entries
    return added


def _package_of(point: EntryPoint) -> str:
    return point.dist.name if point.dist else ""


def _check(name: str, entry: RegistryEntry, taken: Mapping[str, RegistryEntry]) -> None:
    """Raise what is wrong with an entry, before a page finds it."""
    if name in taken:
        raise TypeError(f"there is a parser {name!r} already")
    if entry.queue not in QUEUES:
        raise TypeError(
            f"{name} has the queue {entry.queue!r}, which is none of {', '.join(QUEUES)}"
        )
    describe(_attribute(entry.config))


def _in_order(added: Mapping[str, RegistryEntry]) -> dict[str, RegistryEntry]:
    ordered: dict[str, RegistryEntry] = {}
    for name, each in SHIPPED.items():
        behind = {other: one for other, one in added.items() if one.after == name}
        ordered |= {name: each, **behind}
    return {**ordered, **added}


def _attribute(dotted: str) -> Any:
    module, _, name = dotted.rpartition(".")
    return getattr(import_module(module), name)


@cache
def parsers() -> dict[str, RegistryEntry]:
    """Return all parsers in the order of the pages. The first call asks the installed packages."""
    return _in_order(_registered())


def entry(name: str) -> RegistryEntry:
    """Return the entry called ``name``. Raises Refusal with the names there are."""
    if name not in parsers():
        raise Refusal(
            f"No parser is called {name!r}; there are: {', '.join(parsers())}.", "unknown_parser"
        )
    return parsers()[name]


def title_of(parser: str) -> str:
    """Return what pages call a parser; its name where the registry no longer has it."""
    return parsers()[parser].title if parser in parsers() else parser


def untrained() -> list[str]:
    """Return the names of the parsers that training pairs change nothing of: they answer without a run."""
    return [name for name, each in parsers().items() if not each.learns]


def needing(needs: Needs) -> list[str]:
    """Return the names of the parsers that need this most."""
    return [name for name, each in parsers().items() if each.needs is needs]


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
