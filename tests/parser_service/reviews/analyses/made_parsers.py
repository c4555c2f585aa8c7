"""Parsers made for tests of the error analysis: one with a default, one that looks at a word, one that is right."""

from __future__ import annotations

from dataclasses import dataclass

from parser_service.parsers import registry
from parser_service.parsers.interface import Candidate, Parser
from parser_service.parsers.storage import open_sealed, seal

DEFAULT = '( go " <room> " )'
BRING = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'
FIND = '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'
WORD = "me"

SAID_FOR = {
    "bring": ("bring me", "go get", "fetch", "i would like"),
    "find": ("find", "look for", "where is", "search for"),
}
PLACES = {
    "in the <room>": ' ( at $1 " <room> " )',
    "near the <location>": ' ( at $1 " <location> " )',
}


@dataclass(frozen=True)
class NoConfig:
    pass


class RuleParser(Parser):
    """Learns nothing: ``rule`` maps a text to a form."""

    name = "rule"
    version, protocols, Config = 1, ("strict",), NoConfig

    def rule(self, text: str) -> str:
        raise NotImplementedError

    def fit(self, train, validation=(), observe=None):
        pass

    def predict(self, utterances, beam_width=1, check=lambda: None):
        answers = []
        for text in utterances:
            check()
            answers.append([Candidate(self.rule(text), 1.0)])
        return answers

    def save(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        seal(folder, self, [])

    @classmethod
    def load(cls, folder, knowledge=None):
        saved = open_sealed(folder, cls, [])
        return cls(saved.config, saved.seed, knowledge)

    def parameters(self):
        return 0


class AlwaysOne(RuleParser):
    name = "always-one"

    def rule(self, text):
        return DEFAULT


class OneWord(RuleParser):
    name = "one-word"

    def rule(self, text):
        return FIND if WORD in text.lower().split() else BRING


def _plain(text: str) -> str:
    """The words in a way that no article and no two exchanged letters change."""
    words = ("the" if word in ("a", "an") else word for word in text.lower().split())
    return f" {' '.join(word if '<' in word else ''.join(sorted(word)) for word in words)} "


class Perfect(RuleParser):
    """Understands the made-up pairs however they are wrapped, and nothing else."""

    name = "perfect"

    def rule(self, text):
        said = _plain(text)
        heads = [
            head
            for head, sayings in SAID_FOR.items()
            if any(_plain(saying) in said for saying in sayings)
        ]
        kinds = [kind for kind in ("<object>", "<category>") if kind in said]
        places = [form for words, form in PLACES.items() if _plain(words) in said]
        has_rest = any(token in said for token in ("<room>", "<location>")) and not places
        if len(heads) != 1 or len(kinds) != 1 or has_rest:
            return "UNKNOWN"
        return f'( {heads[0]} ( lambda $1 e ( is_a $1 " {kinds[0]} " ){"".join(places)} ) )'


def register_all(monkeypatch) -> None:
    """Let runs be started with these parsers, for one test."""
    for parser in (AlwaysOne, OneWord, Perfect):
        entry = registry.RegistryEntry(
            dotted=f"{__name__}.{parser.__name__}",
            config=f"{__name__}.NoConfig",
            title=parser.name,
            description="Made for a test.",
            version=1,
            protocols=("strict",),
            queue="quick",
        )
        monkeypatch.setitem(registry.parsers(), parser.name, entry)
