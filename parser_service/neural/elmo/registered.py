"""The row of the paper with the vectors of ELMo, as the registry is told."""

from __future__ import annotations

from parser_service.parsers.conditions import Protocol
from parser_service.parsers.registry_entry import Needs, RegistryEntry

PARSERS = {
    "seq2seq-glove-elmo": RegistryEntry(
        dotted="parser_service.neural.elmo.row.Seq2SeqGloveElmo",
        config="parser_service.neural.elmo.config.GloveElmoConfig",
        title="Seq2seq + GloVe, ELMo",
        description="Sequence to sequence with GloVe and, frozen, the layers of ELMo under a "
        "learned mix.",
        version=1,
        protocols=(Protocol.STRICT,),
        in_short="The same network with GloVe and ELMo; the first pass over the texts is slow on a CPU.",
        needs=Needs.WEIGHTS,
        published={
            ("gen", "gen"): (98.8, 36.2),
            ("gen", "para"): (21.3, 0.0),
            ("para", "para"): (77.3, 22.1),
            ("gen+para", "para"): (85.4, 34.4),
        },
        after="seq2seq-glove",
    ),
}
