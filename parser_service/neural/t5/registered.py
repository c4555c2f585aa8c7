"""The fine-tuned encoder–decoder, as the registry is told."""

from __future__ import annotations

from parser_service.parsers.conditions import Protocol
from parser_service.parsers.registry_entry import Expectation, Needs, RegistryEntry

PARSERS = {
    "t5": RegistryEntry(
        dotted="parser_service.neural.t5.t5_parser.T5",
        config="parser_service.neural.t5.config.EncoderDecoderConfig",
        title="Encoder–decoder (T5, BART)",
        description="Fine-tunes a pretrained encoder–decoder to write forms; what it may write is "
        "free, one of a list of forms, or whatever the signatures of predicates allow.",
        version=1,
        protocols=(Protocol.STRICT, Protocol.DOMAIN),
        in_short="Fine-tunes a T5 or BART that you bring to write the form; a GPU is recommended.",
        needs=Needs.WEIGHTS,
        expected=Expectation(
            instead="that of the weights you bring", time="depends on them", memory="8 GB or a GPU"
        ),
        after="ranker",
    ),
}
