"""A sequence-to-sequence parser that also reads vectors of a frozen contextual encoder."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from torch import Tensor

from parser_service.neural.device import threads
from parser_service.neural.seq2seq.parser import Seq2Seq
from parser_service.neural.word_vectors.contextual import ContextualEncoder
from parser_service.neural.word_vectors.scalar_mix import ContextShape
from parser_service.neural.word_vectors.vector_cache import VectorCache
from parser_service.parsers.interface import Observer, Pair
from parser_service.parsers.weights.encoder_places import encoders_folder, vectors_folder
from parser_service.parsers.weights.files import refuse_missing_weights
from parser_service.parsers.words import words

ENCODER = "encoder"  # what is saved of it, beside the vocabularies


class WithContext(Seq2Seq):
    """Reads for each word its own vector and, concatenated to it, that of the frozen encoder in context.

    The encoder is not saved with the parser, only its hash: loading looks for it where training did,
    and refuses another one.
    """

    _vectors: VectorCache | None = None

    @abstractmethod
    def _find_encoder(self, encoders: Path | None) -> ContextualEncoder:
        """Load the encoder that the configuration names. Raises ValueError, which says what to put where."""

    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        observe = observe or Observer()
        refuse_missing_weights(self.config)
        cache = self._open()
        utterances = {words(pair.utterance) for pair in (*train, *validation)}
        observe.log(
            f"Encoding {len(utterances)} utterances with the encoder {cache.encoder.identity}."
        )
        with threads(self.config.threads):
            cache.prepare(utterances, observe.check, _reporter(observe))
        super().fit(train, validation, observe)

    def _open(self) -> VectorCache:
        """Return the encoder with its cached vectors, loading it the first time."""
        if self._vectors is None:
            encoder = self._find_encoder(encoders_folder())
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
            raise ValueError(
                f"{folder} was trained on an encoder with the SHA-256 {wanted}, but the one found "
                f"under its name has {present}. Put the former back, or train again."
            )


def _reporter(observe: Observer) -> Callable[[int, int], None]:
    def report(done: int, of: int) -> None:
        observe.progress(0.0, f"encoded {done} of {of} utterances with the frozen encoder")

    return report
