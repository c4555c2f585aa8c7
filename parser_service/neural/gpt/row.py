"""The row of Walker et al. 2019 with the vectors of OpenAI's GPT."""

from __future__ import annotations

from parser_service.neural.gpt.config import GloveGptConfig
from parser_service.neural.seq2seq.rows import WithContext, WithGlove


class Seq2SeqGloveGpt(WithContext, WithGlove):
    """GloVe beside OpenAI's GPT."""

    name = "seq2seq-glove-gpt"
    version = 1
    Config = GloveGptConfig
