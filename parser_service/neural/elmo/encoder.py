"""ELMo: word vectors from the states of a language model in two directions (Peters et al. 2018)."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path

import torch
from torch import Tensor

from parser_service.neural.device import full_fp32, processor
from parser_service.neural.elmo.config import find_elmo
from parser_service.neural.elmo.files import (
    BACKWARD,
    FORWARD,
    ElmoOptions,
    open_weights,
    read_elmo_options,
)
from parser_service.neural.elmo.layers import ProjectedLstm, spell
from parser_service.parsers.storage import file_hash


class Elmo:
    """The character CNN and each bidirectional LSTM layer, frozen.

    Each utterance is read with an empty memory, so its vectors never depend on what was read before
    it; the published programs carried their memory from batch to batch.
    """

    def __init__(self, options: Path, weights: Path):
        """Read the files. Raises Refusal where they are not an ELMo's."""
        self.options: ElmoOptions = read_elmo_options(options)
        self.identity = sha256(f"{file_hash(options)} {file_hash(weights)}".encode()).hexdigest()
        with open_weights(weights, self.options) as file:
            self._cnn = file.character_cnn()
            layers = range(self.options.layers)
            self._forward = [file.lstm(FORWARD, layer) for layer in layers]
            self._backward = [file.lstm(BACKWARD, layer) for layer in layers]

    @classmethod
    def named(cls, name: str, encoders: Path | None = None) -> Elmo:
        """Load the ELMo in the folder ``name``. Raises Refusal, which says what to put where."""
        files = find_elmo(name, encoders)
        return cls(files.options, files.weights)

    @property
    def layers(self) -> int:
        """Return the number of vectors per word: one without context, and one for each LSTM layer."""
        return 1 + self.options.layers

    @property
    def width(self) -> int:
        return self.options.width

    @torch.no_grad()
    def vectors(self, words: Sequence[str]) -> Tensor:
        """Encode one utterance. Shape [words, layers, width]; a layer is forward and backward, concatenated."""
        spelled = torch.tensor(spell(words, self.options.longest_word))  # [words + 2, longest]
        with full_fp32():
            plain = self._cnn(spelled.to(processor()))  # [words + 2, width / 2]
        ahead = self._read(plain, self._forward)
        behind = self._read(plain.flip(0), self._backward)
        layers = [
            torch.cat((one, other.flip(0)), dim=-1)  # [words + 2, width]
            for one, other in zip(ahead, behind, strict=True)
        ]
        inner = torch.stack(layers, dim=1)[1:-1]  # without the sentence's begin and end
        return inner.to("cpu", copy=True)

    def _read(self, words: Tensor, lstms: Sequence[ProjectedLstm]) -> list[Tensor]:
        """Return ``words`` and the output of each layer in one direction, each [words, width / 2]."""
        outputs = [words]
        for index, lstm in enumerate(lstms):
            read = lstm(outputs[-1])
            is_skipped = index > 0 and self.options.has_skips
            outputs.append(read + outputs[-1] if is_skipped else read)
        return outputs
