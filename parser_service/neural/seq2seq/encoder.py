"""The encoder: reads an utterance in both directions."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn
from torch.nn.utils.rnn import pack_padded_sequence, pad_packed_sequence

from parser_service.neural.seq2seq.embeddings import Dropout, WordEmbedding
from parser_service.neural.word_vectors.scalar_mix import ScalarMix


@dataclass(frozen=True, slots=True)
class Encoded:
    """What the decoder sees of a batch of utterances."""

    states: Tensor  # [batch, source length, hidden]
    mask: Tensor  # [batch, source length], true on words
    final: Tensor  # [batch, hidden], both directions after their last word

    def repeat(self, times: int) -> Encoded:
        """Repeat each utterance ``times`` times in a row, once for each hypothesis of a beam."""
        return Encoded(
            self.states.repeat_interleave(times, dim=0),  # [batch * times, source length, hidden]
            self.mask.repeat_interleave(times, dim=0),  # [batch * times, source length]
            self.final.repeat_interleave(times, dim=0),  # [batch * times, hidden]
        )


class Encoder(nn.Module):
    """One bidirectional LSTM layer over word vectors, concatenated with those of a frozen encoder where
    there is one."""

    def __init__(
        self,
        embedding: WordEmbedding,
        hidden_size: int,
        dropout: Dropout,
        mix: ScalarMix | None = None,
    ):
        super().__init__()
        self.embedding = embedding
        self.dropout = dropout
        self.mix = mix
        width = embedding.embedding_dim + (mix.width if mix else 0)
        self.lstm = nn.LSTM(width, hidden_size // 2, batch_first=True, bidirectional=True)

    def forward(self, source: Tensor, lengths: Tensor, context: Tensor | None = None) -> Encoded:
        """Encode ``source`` [batch, source length] with its ``lengths`` [batch] and, where there is a mix,
        ``context`` [batch, source length, layers, width]; all in the main memory."""
        device = self.embedding.weight.device
        words = self.embedding(source.to(device))  # [batch, source length, embedding]
        if self.mix is not None:
            words = torch.cat((words, self.mix(context)), dim=-1)
        vectors = self.dropout(words)  # [batch, source length, embedding and width of the mix]
        packed = pack_padded_sequence(vectors, lengths, batch_first=True, enforce_sorted=False)
        read, (final, _) = self.lstm(packed)  # final: [2, batch, hidden / 2]
        states, _ = pad_packed_sequence(read, batch_first=True)  # [batch, source length, hidden]
        positions = torch.arange(source.shape[1])  # [source length]
        return Encoded(
            states=self.dropout(states),
            mask=(positions < lengths[:, None]).to(device),
            final=torch.cat((final[0], final[1]), dim=-1),
        )
