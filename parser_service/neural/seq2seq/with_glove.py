"""A sequence-to-sequence parser whose word vectors start as GloVe's and are trained further."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import torch
from torch import Tensor

from parser_service.neural.seq2seq.parser import Seq2Seq
from parser_service.neural.seq2seq.vocabulary import Vocabulary
from parser_service.neural.word_vectors.glove import read_glove
from parser_service.parsers.hyperparameters.vectors import GloveConfig
from parser_service.parsers.interface import Observer, Pair
from parser_service.parsers.weights.encoder_places import encoders_folder
from parser_service.parsers.weights.files import find_glove, refuse_missing_weights


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
