"""The layers of ELMo, frozen: each holds the tensors that its HDF5 file names. The first reads the bytes of words."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import torch
from torch import Tensor
from torch.nn.functional import conv1d

# Numbers 0 to 255 are bytes.
SENTENCE_BEGIN, SENTENCE_END, WORD_BEGIN, WORD_END, PADDING = range(256, 261)
CHARACTERS = 261  # rows of the published table; files that also count a mask say one more
FORGET_BIAS = 1.0  # added when the published cells run, and not in their file


def spell(sentence: Sequence[str], longest: int) -> list[list[int]]:
    """Return the characters of each word of ``sentence``, whose begin and end are words of their own.

    Shape [words + 2, longest]; a word is cut where it is longer with its two markers.
    """
    words = [list(word.encode("utf-8")) for word in sentence]
    rows = []
    for word in ([SENTENCE_BEGIN], *words, [SENTENCE_END]):
        marked = [WORD_BEGIN, *word[: longest - 2], WORD_END]
        rows.append(marked + [PADDING] * (longest - len(marked)))
    return rows


@dataclass(frozen=True, slots=True, eq=False)
class Affine:
    """x W + b."""

    weight: Tensor  # [in, out]
    bias: Tensor  # [out]

    def __call__(self, values: Tensor) -> Tensor:
        return values @ self.weight + self.bias  # [..., out]


@dataclass(frozen=True, slots=True, eq=False)
class Highway:
    """Carries part of its input past its transform (Srivastava et al. 2015).

    In ELMo's files the *carry* gate weighs what was transformed, whatever its name says.
    """

    gate: Affine
    transform: Affine

    def __call__(self, values: Tensor) -> Tensor:
        share = torch.sigmoid(self.gate(values))  # as values
        return share * torch.relu(self.transform(values)) + (1 - share) * values


@dataclass(frozen=True, slots=True, eq=False)
class Convolution:
    """One width of the character CNN: the largest value of each filter over all places."""

    weight: Tensor  # [filters, character size, width]
    bias: Tensor  # [filters]
    activation: Callable[[Tensor], Tensor]

    def __call__(self, characters: Tensor) -> Tensor:
        """Map [words, character size, longest word] to [words, filters]."""
        places = conv1d(characters, self.weight, self.bias)  # [words, filters, places]
        return self.activation(places.amax(dim=-1))


@dataclass(frozen=True, slots=True, eq=False)
class CharacterCnn:
    """Words from their characters, without regard to context (Kim et al. 2016)."""

    table: Tensor  # [characters, character size]
    convolutions: tuple[Convolution, ...]
    highways: tuple[Highway, ...]
    projection: Affine

    def __call__(self, spelled: Tensor) -> Tensor:
        """Map [words, longest word] to [words, projection]."""
        characters = self.table[spelled].transpose(1, 2)  # [words, character size, longest word]
        values = torch.cat([each(characters) for each in self.convolutions], dim=-1)
        for highway in self.highways:
            values = highway(values)  # [words, filters]
        return self.projection(values)


@dataclass(frozen=True, slots=True, eq=False)
class ProjectedLstm:
    """An LSTM whose output is projected, with clipped cells and outputs (Sak et al. 2014)."""

    gates: Affine  # [projection + projection, 4 * cells]: input, candidate, forget, output
    projection: Tensor  # [cells, projection]
    cell_clip: float
    projection_clip: float

    def __call__(self, words: Tensor) -> Tensor:
        """Map [words, projection] to the same, read from the first to the last."""
        output = words.new_zeros(self.projection.shape[1])  # [projection]
        cell = words.new_zeros(self.projection.shape[0])  # [cells]
        outputs = []
        for word in words:
            entry, candidate, forget, exit_ = self.gates(torch.cat((word, output))).chunk(4)
            kept = torch.sigmoid(forget + FORGET_BIAS) * cell
            cell = kept + torch.sigmoid(entry) * torch.tanh(candidate)
            cell = cell.clamp(-self.cell_clip, self.cell_clip)
            output = (torch.sigmoid(exit_) * torch.tanh(cell)) @ self.projection
            output = output.clamp(-self.projection_clip, self.projection_clip)
            outputs.append(output)
        return torch.stack(outputs)
