"""The encoder: reads an utterance in both directions."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn
from torch.nn.utils.rnn import pack_padded_sequence, pad_packed_sequence

from parser_service.neural.embeddings import Dropout, WordEmbedding


@dataclass(frozen=True, slots=True)
class Encoded:
    """What the decoder sees of a batch of utterances."""

    states: Tensor  # [batch, source length, hidden]
    mask: Tensor  # [batch, source length], true on words
    final: Tensor  # [batch, hidden], both directions after their last word

    def repeated(self, times: int) -> Encoded:
        """Each utterance ``times`` times in a row: one for each hypothesis of a beam."""
        return Encoded(
            self.states.repeat_interleave(times, dim=0),  # [batch * times, source length, hidden]
            self.mask.repeat_interleave(times, dim=0),  # [batch * times, source length]
            self.final.repeat_interleave(times, dim=0),  # [batch * times, hidden]
        )


class Encoder(nn.Module):
    """One bidirectional LSTM layer over word vectors."""

    def __init__(self, embedding: WordEmbedding, hidden_size: int, dropout: Dropout):
        super().__init__()
        self.embedding = embedding
        self.dropout = dropout
        self.lstm = nn.LSTM(
            embedding.embedding_dim, hidden_size // 2, batch_first=True, bidirectional=True
        )

    def forward(self, source: Tensor, lengths: Tensor) -> Encoded:
        """``source`` [batch, source length], ``lengths`` [batch]."""
        vectors = self.dropout(self.embedding(source))  # [batch, source length, embedding]
        packed = pack_padded_sequence(vectors, lengths, batch_first=True, enforce_sorted=False)
        read, (final, _) = self.lstm(packed)  # final: [2, batch, hidden / 2]
        states, _ = pad_packed_sequence(read, batch_first=True)  # [batch, source length, hidden]
        positions = torch.arange(source.shape[1])  # [source length]
        return Encoded(
            states=self.dropout(states),
            mask=positions < lengths[:, None],
            final=torch.cat((final[0], final[1]), dim=-1),
        )
