"""Pairs as padded tensors, in batches of similar length."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import torch
from torch import Tensor
from torch.nn.functional import pad as pad_ends
from torch.nn.utils.rnn import pad_sequence

from parser_service.neural.seq2seq.vocabulary import END, PADDING, START

POOL = 8  # batches sorted by length together: little padding, yet another mix each epoch


@dataclass(frozen=True, slots=True)
class NumberedPair:
    """One pair in numbers: the words of the utterance, the tokens of the form and, where there is a
    frozen encoder, its vectors of the words [words, layers, width]."""

    source: list[int]
    target: list[int]
    context: Tensor | None = None


@dataclass(frozen=True, slots=True)
class Batch:
    """Some examples, padded."""

    source: Tensor  # [batch, source length]
    lengths: Tensor  # [batch], words of each utterance
    inputs: Tensor  # [batch, target length], START and the tokens of the form
    outputs: Tensor  # [batch, target length], the tokens of the form and END
    context: Tensor | None = None  # [batch, source length, layers, width]


def pad(sequences: Sequence[Sequence[int]]) -> Tensor:
    """Return numbers as one tensor [sequences, longest], filled up with ``PADDING``."""
    longest = max(map(len, sequences))
    rows = [[*sequence, *[PADDING] * (longest - len(sequence))] for sequence in sequences]
    return torch.tensor(rows)  # [sequences, longest]


def sources(utterances: Sequence[Sequence[int]]) -> tuple[Tensor, Tensor]:
    """Return padded utterances [batch, source length] and their lengths [batch]. Each ends with END, so
    an utterance without words has a length, too."""
    closed = [[*utterance, END] for utterance in utterances]
    return pad(closed), torch.tensor([len(utterance) for utterance in closed])


def contexts(vectors: Sequence[Tensor | None]) -> Tensor | None:
    """Return vectors of utterances [words, layers, width] as one tensor [batch, source length, layers,
    width], zero for END and padding; None where there are none."""
    present = [each for each in vectors if each is not None]
    if not present:
        return None
    padded = pad_sequence(present, batch_first=True)  # [batch, source length - 1, layers, width]
    return pad_ends(padded, (0, 0, 0, 0, 0, 1))


def collate(examples: Sequence[NumberedPair]) -> Batch:
    """Make one batch of ``examples``."""
    source, lengths = sources([example.source for example in examples])
    inputs = pad([[START, *example.target] for example in examples])
    outputs = pad([[*example.target, END] for example in examples])
    context = contexts([example.context for example in examples])
    return Batch(source, lengths, inputs, outputs, context)


def in_order(examples: Sequence[NumberedPair], size: int) -> Iterator[Batch]:
    """Yield batches of ``size`` in the given order."""
    for begin in range(0, len(examples), size):
        yield collate(examples[begin : begin + size])


def shuffle(
    examples: Sequence[NumberedPair], size: int, generator: torch.Generator
) -> Iterator[Batch]:
    """Yield batches of ``size`` in random order, each of forms of similar length."""
    order = torch.randperm(len(examples), generator=generator).tolist()
    chunks: list[list[int]] = []
    for begin in range(0, len(order), size * POOL):
        pool = sorted(order[begin : begin + size * POOL], key=lambda i: len(examples[i].target))
        chunks += [pool[at : at + size] for at in range(0, len(pool), size)]
    for chunk in torch.randperm(len(chunks), generator=generator).tolist():
        yield collate([examples[index] for index in chunks[chunk]])
