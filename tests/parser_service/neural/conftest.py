"""A toy language, small enough to be learned in seconds on one thread."""

from dataclasses import asdict, replace
from pathlib import Path
from shutil import rmtree

import pytest

from parser_service.parsers import pretrained_files
from parser_service.parsers.hyperparameters.seq2seq import Seq2SeqConfig
from parser_service.parsers.interface import Cancelled, Observer, Pair
from parser_service.parsers.registry import load_class

SMALL = Seq2SeqConfig(
    embedding_size=16,
    hidden_size=32,
    minimum_count=1,
    learning_rate=0.01,
    batch_size=8,
    epochs=6,
    patience=6,
    beam_width=3,
    threads=1,
)
LONGER = replace(SMALL, epochs=80, patience=80)
QUICK = asdict(replace(SMALL, epochs=3, patience=3, beam_width=2))
PRETRAINED = {  # the rows that read pretrained words, and what they look for
    "seq2seq-glove": {},
    "seq2seq-glove-elmo": {"elmo": "elmo"},
    "seq2seq-glove-gpt": {"encoder": "gpt"},
    "seq2seq-glove-bert-base": {"encoder": "bert"},
    "seq2seq-glove-bert-large": {"encoder": "bert"},
    "seq2seq-minilm": {"encoder": "bert"},
}
VERBS = {"bring": "bring", "fetch": "bring", "find": "find", "look for": "find"}
HELD_OUT = "fetch the <object> in the <room>"
PLACES = ("", " in the <room>", " at the <location>")


def toy_pairs() -> list[Pair]:
    """28 commands, 8 forms."""
    return [
        Pair(f"{verb} {word} <{kind}>{place}", form(action, kind, place))
        for verb, action in VERBS.items()
        for kind in ("object", "name")
        for word in (("the",) if kind == "name" else ("a", "the"))
        for place in PLACES
        if kind == "object" or not place
    ]


def form(action: str, kind: str, place: str) -> str:
    at = f' ( at $1 " {place.split()[-1]} " )' if place else ""
    predicate = "is_a" if kind == "object" else "name"
    return f'( {action} ( lambda $1 e ( {predicate} $1 " <{kind}> " ){at} ) )'


class Recorder(Observer):
    """Keeps what a run keeps: epochs, log, the last and the best checkpoint; stops when told."""

    def __init__(self, folder: Path, stop_after_checks: int | None = None):
        self.folder = folder
        self.checks_left = stop_after_checks
        self.epochs, self.lines, self.fractions = [], [], []

    def check(self):
        if self.checks_left is not None:
            self.checks_left -= 1
            if self.checks_left < 0:
                raise Cancelled

    def epoch(self, report):
        self.epochs.append(report)

    def log(self, message):
        self.lines.append(message)

    def progress(self, fraction, message=""):
        self.fractions.append(fraction)

    def checkpoint(self, epoch, is_best, write):
        for name in ("last", "best") if is_best else ("last",):
            rmtree(self.folder / name, ignore_errors=True)
            (self.folder / name).mkdir(parents=True)
            write(self.folder / name)

    def last_checkpoint(self):
        folder = self.folder / "last"
        return folder if folder.exists() else None


class StoppedOnce(Recorder):
    """Stops the run in its second epoch; listens quietly to what goes on from there."""

    has_stopped = False

    def check(self):
        if self.epochs and not self.has_stopped:
            self.has_stopped = True
            raise Cancelled


def parser_of(name, seed=1, **changes):
    """A parser of one of these names for a training in seconds."""
    parser = load_class(name)
    glove = {"glove": "tiny.txt"} if "glove" in name else {}
    return parser(parser.Config(**{**QUICK, **glove, **PRETRAINED.get(name, {}), **changes}), seed)


@pytest.fixture(scope="session")
def pairs():
    return toy_pairs()


@pytest.fixture(scope="session")
def trained(pairs):
    """A parser that knows the toy language, from all pairs but one."""
    from parser_service.neural.seq2seq.seq2seq_parser import Seq2Seq

    parser = Seq2Seq(LONGER, seed=1)
    parser.fit([pair for pair in pairs if pair.utterance != HELD_OUT])
    return parser


@pytest.fixture(scope="session")
def encoders(tmp_path_factory):
    """A folder of encoders as GPSR_ENCODERS_DIR names one."""
    from tests.parser_service.neural.tiny_weights import (
        write_bert,
        write_elmo,
        write_glove,
        write_gpt,
    )

    folder = tmp_path_factory.mktemp("encoders")
    known = ("bring", "fetch", "the", "a", "unused")
    write_glove(folder / "tiny.txt.gz", known, SMALL.embedding_size, packed=True)
    write_elmo(folder / "elmo")
    write_gpt(folder / "gpt")
    write_bert(folder / "bert")
    return folder


@pytest.fixture
def kept_there(encoders, tmp_path, monkeypatch):
    """Has parsers find those encoders, and keep vectors in a folder of the test."""
    monkeypatch.setattr(pretrained_files, "_encoders", encoders)
    monkeypatch.setattr(pretrained_files, "_vectors", tmp_path / "vectors")
