"""The row of Walker et al. 2019 with the vectors of ELMo."""

from __future__ import annotations

from parser_service.neural.elmo.config import GloveElmoConfig
from parser_service.neural.elmo.encoder import Elmo
from parser_service.neural.seq2seq.rows import WithContext, WithGlove
from parser_service.neural.word_vectors.contextual import ContextualEncoder
from parser_service.parsers.pretrained_files import encoders_folder


class Seq2SeqGloveElmo(WithContext, WithGlove):
    """GloVe beside a learned mix of ELMo's three layers."""

    name = "seq2seq-glove-elmo"
    version = 1
    Config = GloveElmoConfig
    config: GloveElmoConfig

    def _find_encoder(self) -> ContextualEncoder:
        return Elmo.named(self.config.elmo, encoders_folder())
