"""The parser that asks a language model, as the registry is told."""

from __future__ import annotations

from parser_service.parsers.conditions import Protocol
from parser_service.parsers.registry_entry import Expectation, Needs, RegistryEntry

PARSERS = {
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
        expected=Expectation(instead="that of the model", time="no training; seconds an answer"),
    ),
}
