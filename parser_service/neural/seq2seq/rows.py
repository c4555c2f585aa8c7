"""The rows of Walker et al. 2019 with pretrained vectors, and one with a small sentence encoder."""

from __future__ import annotations

from pathlib import Path

from parser_service.neural.seq2seq.with_context import WithContext
from parser_service.neural.seq2seq.with_glove import WithGlove
from parser_service.neural.word_vectors.contextual import ContextualEncoder, TransformerWords
from parser_service.neural.word_vectors.elmo import Elmo
from parser_service.parsers.hyperparameters.vectors import (
    GloveBertBaseConfig,
    GloveBertLargeConfig,
    GloveConfig,
    GloveElmoConfig,
    GloveGptConfig,
    MiniLmConfig,
)


class Seq2SeqGlove(WithGlove):
    """Learned word vectors that start as GloVe's."""

    name = "seq2seq-glove"
    version = 1
    Config = GloveConfig


class Seq2SeqGloveElmo(WithContext, WithGlove):
    """GloVe beside a learned mix of ELMo's three layers."""

    name = "seq2seq-glove-elmo"
    version = 1
    Config = GloveElmoConfig
    config: GloveElmoConfig

    def _find_encoder(self, encoders: Path | None) -> ContextualEncoder:
        return Elmo.named(self.config.elmo, encoders)


class WithTransformer(WithContext):
    """The last layer of the transformer that the configuration names."""

    def _find_encoder(self, encoders: Path | None) -> ContextualEncoder:
        return TransformerWords.named(self.config.encoder, encoders)


class Seq2SeqGloveGpt(WithTransformer, WithGlove):
    """GloVe beside OpenAI's GPT."""

    name = "seq2seq-glove-gpt"
    version = 1
    Config = GloveGptConfig


class Seq2SeqGloveBertBase(WithTransformer, WithGlove):
    """GloVe beside the smaller BERT."""

    name = "seq2seq-glove-bert-base"
    version = 1
    Config = GloveBertBaseConfig


class Seq2SeqGloveBertLarge(WithTransformer, WithGlove):
    """GloVe beside the larger BERT."""

    name = "seq2seq-glove-bert-large"
    version = 1
    Config = GloveBertLargeConfig


class Seq2SeqMiniLm(WithTransformer):
    """Word vectors learned from the training pairs beside a small sentence encoder's words."""

    name = "seq2seq-minilm"
    version = 1
    Config = MiniLmConfig
