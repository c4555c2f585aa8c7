"""The rows of Walker et al. 2019 with pretrained vectors, and one with a small sentence encoder."""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus
from itertools import chain
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from annotations.language.texts import Refusal
from parser_service.neural.device import threads
from parser_service.neural.seq2seq.seq2seq_parser import Seq2Seq
from parser_service.neural.seq2seq.vocabulary import Vocabulary
from parser_service.neural.word_vectors.contextual import ContextualEncoder, TransformerWords
from parser_service.neural.word_vectors.glove import read_glove
from parser_service.neural.word_vectors.scalar_mix import ContextShape
from parser_service.neural.word_vectors.vector_cache import VectorCache
from parser_service.parsers.hyperparameters.vectors import (
    GloveBertBaseConfig,
    GloveBertLargeConfig,
    GloveConfig,
    MiniLmConfig,
)
from parser_service.parsers.interface import Observer, Pair
from parser_service.parsers.pretrained_files import (
    encoders_folder,
    find_glove,
    refuse_missing_weights,
    vectors_folder,
)
from parser_service.parsers.words import words

ENCODER = "encoder"  # what is saved of it, beside the vocabularies


class WithGlove(Seq2Seq):
    """Knows each training word that GloVe has, however rare, and of the others those that ``seq2seq`` would.

    The trained vectors are saved with the parser: loading one needs no file of GloVe.
    """

    config: GloveConfig

    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        refuse_missing_weights(self.config)
        super().fit(train, validation, observe)

    def _read_vocabularies(self, train: Sequence[Pair]) -> None:
        super()._read_vocabularies(train)
        with torch.no_grad():
            for word, vector in self._glove.items():
                [number] = self._source.numbers([word])
                self._model.encoder.embedding.weight[number] = vector

    def _source_vocabulary(self, commands: Sequence[tuple[str, ...]]) -> Vocabulary:
        path = find_glove(self.config.glove, encoders_folder())
        seen = set(chain.from_iterable(commands))
        self._glove: dict[str, Tensor] = read_glove(path, seen, self.config.embedding_size)
        frequent = super()._source_vocabulary(commands).words
        return Vocabulary(sorted({*frequent, *self._glove}))


class WithContext(Seq2Seq):
    """Reads for each word its own vector and, concatenated to it, that of the frozen encoder in context.

    The encoder is a transformer, of which the last layer is read, unless a subclass finds another one. It is
    not saved with the parser, only its hash: loading looks for it where training did, and refuses another one.
    """

    _vectors: VectorCache | None = None

    def _find_encoder(self) -> ContextualEncoder:
        """Load the encoder that the configuration names. Raises Refusal, which says what to put where."""
        return TransformerWords.named(self.config.encoder, encoders_folder())

    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        observe = observe or Observer()

        def report(done: int, of: int) -> None:
            observe.progress(0.0, f"encoded {done} of {of} utterances with the frozen encoder")

        refuse_missing_weights(self.config)
        cache = self._open()
        utterances = {words(pair.utterance) for pair in (*train, *validation)}
        observe.log(
            f"Encoding {len(utterances)} utterances with the encoder {cache.encoder.identity}."
        )
        with threads(self.config.threads):
            cache.prepare(utterances, observe.check, report)
        super().fit(train, validation, observe)

    def _open(self) -> VectorCache:
        """Return the encoder with its cached vectors, loading it the first time."""
        if self._vectors is None:
            encoder = self._find_encoder()
            self._shape = ContextShape(encoder.layers, encoder.width)
            self._vectors = VectorCache(encoder, vectors_folder())
        return self._vectors

    def _context(self, utterance: tuple[str, ...]) -> Tensor:
        return self._open().of(utterance)

    def _describe(self) -> dict[str, Any]:
        return {ENCODER: self._open().encoder.identity}

    def _restore(self, folder: Path, described: dict[str, Any]) -> None:
        wanted, present = described.get(ENCODER), self._open().encoder.identity
        if wanted != present:
            raise Refusal(
                f"{folder} was trained on an encoder with the SHA-256 {wanted}, but the one found "
                f"under its name has {present}. Put the former back, or train again.",
                "other_encoder",
                HTTPStatus.CONFLICT,
            )


class Seq2SeqGlove(WithGlove):
    """Learned word vectors that start as GloVe's."""

    name = "seq2seq-glove"
    version = 1
    Config = GloveConfig


class Seq2SeqGloveBertBase(WithContext, WithGlove):
    """GloVe beside the smaller BERT."""

    name = "seq2seq-glove-bert-base"
    version = 1
    Config = GloveBertBaseConfig


class Seq2SeqGloveBertLarge(WithContext, WithGlove):
    """GloVe beside the larger BERT."""

    name = "seq2seq-glove-bert-large"
    version = 1
    Config = GloveBertLargeConfig


class Seq2SeqMiniLm(WithContext):
    """Word vectors learned from the training pairs beside a small sentence encoder's words."""

    name = "seq2seq-minilm"
    version = 1
    Config = MiniLmConfig
