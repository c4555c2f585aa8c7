"""Frozen encoders that give each word of an utterance a vector in its context."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

import torch
from tokenizers import Tokenizer
from torch import Tensor

from parser_service.neural.device import processor
from parser_service.neural.pretrained import Pretrained, encoder_hash, load_encoder

LONGEST = 256  # subwords; the longest published paraphrase has 45


class ContextualEncoder(Protocol):
    """What a parser needs of an encoder. ``identity`` is the hash of everything that decides its vectors."""

    identity: str

    @property
    def layers(self) -> int:
        """Return the number of vectors per word."""

    @property
    def width(self) -> int:
        """Return the number of values per vector."""

    def vectors(self, words: Sequence[str]) -> Tensor:
        """Encode one utterance. Shape [words, layers, width], in the main memory, without gradient."""


class TransformerWords:
    """The last layer of a transformer, as the mean over the subwords of each word.

    Each utterance is encoded alone: in a batch with others its vectors would be rounded differently.
    """

    layers = 1

    def __init__(self, pretrained: Pretrained):
        self.identity = encoder_hash(pretrained.folder)
        model: Any = pretrained.model  # whose own types say too little
        self._model = model.requires_grad_(False).to(processor()).eval().float()
        text = pretrained.tokenizer.backend_tokenizer.to_str()
        self._tokenizer: Tokenizer = Tokenizer.from_str(text)
        self._tokenizer.no_padding()
        self._tokenizer.enable_truncation(min(LONGEST, self._model.config.max_position_embeddings))

    @classmethod
    def named(cls, name: str, encoders: Path | None = None) -> TransformerWords:
        """Load the transformer ``name``. Raises Refusal, which says what to put where."""
        with torch.random.fork_rng(devices=[]):  # parts that the file lacks are drawn, but not used
            return cls(load_encoder(name, encoders))

    @property
    def width(self) -> int:
        return int(self._model.config.hidden_size)

    @torch.no_grad()
    def vectors(self, words: Sequence[str]) -> Tensor:
        """Encode one utterance. Shape [words, 1, width]."""
        if not words:
            return torch.zeros(0, 1, self.width)
        encoding = self._tokenizer.encode(list(words), is_pretokenized=True)
        subwords = torch.tensor([encoding.ids], device=self._model.device)  # [1, subwords]
        states = self._model(input_ids=subwords, attention_mask=torch.ones_like(subwords))
        last = states.last_hidden_state[0].cpu()  # [subwords, width]
        return mean_by_word(last, encoding.word_ids, len(words))[:, None]


def mean_by_word(subwords: Tensor, words: Sequence[int | None], number: int) -> Tensor:
    """Return the mean vector of each word's subwords.

    Args:
        subwords: [subwords, width].
        words: the word that each subword is part of; None for special tokens.
        number: the number of words.

    Returns:
        [number, width]; zero for a word without subwords, such as one that was cut off.
    """
    places = [place for place, word in enumerate(words) if word is not None]
    owners = torch.tensor([word for word in words if word is not None], dtype=torch.long)
    sums = subwords.new_zeros(number, subwords.shape[1])
    sums.index_add_(0, owners, subwords[places])
    counts = torch.bincount(owners, minlength=number).clamp(min=1)  # [number]
    return sums / counts[:, None]
