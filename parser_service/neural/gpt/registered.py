"""The row of the paper with the vectors of OpenAI's GPT, as the registry is told."""

from __future__ import annotations

from parser_service.parsers.conditions import Protocol
from parser_service.parsers.registry_entry import Needs, RegistryEntry

PARSERS = {
    "seq2seq-glove-gpt": RegistryEntry(
        dotted="parser_service.neural.gpt.row.Seq2SeqGloveGpt",
        config="parser_service.neural.gpt.config.GloveGptConfig",
        title="Seq2seq + GloVe, GPT",
        description="Sequence to sequence with GloVe and, frozen, the last layer of OpenAI's GPT.",
        version=1,
        protocols=(Protocol.STRICT,),
        in_short="The same network with GloVe and OpenAI's first GPT.",
        needs=Needs.WEIGHTS,
        published={
            ("gen", "gen"): (97.9, 24.6),
            ("gen", "para"): (27.6, 1.8),
            ("para", "para"): (78.2, 26.3),
            ("gen+para", "para"): (89.0, 37.9),
        },
        after="seq2seq-glove",
    ),
}
