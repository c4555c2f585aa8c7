"""The decoder: writes a form token by token, attending to the utterance."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from parser_service.neural.seq2seq.attention import BilinearAttention
from parser_service.neural.seq2seq.embeddings import WordEmbedding
from parser_service.neural.seq2seq.encoder import Encoded


@dataclass(frozen=True, slots=True)
class State:
    """The memory of the decoder between two tokens."""

    hidden: Tensor  # [1, batch, hidden]
    cell: Tensor  # [1, batch, hidden]

    def rows(self, indices: Tensor) -> State:
        """Return the memory of the chosen rows; ``indices`` [rows]."""
        return State(self.hidden[:, indices], self.cell[:, indices])


class Decoder(nn.Module):
    """One LSTM layer. Attention comes between it and the output, so that training reads a whole form in
    one call (Dong and Lapata 2016, section 3.2)."""

    def __init__(self, embedding: WordEmbedding, hidden_size: int):
        super().__init__()
        self.embedding = embedding
        self.bridge = nn.Linear(hidden_size, hidden_size)
        self.lstm = nn.LSTM(embedding.embedding_dim, hidden_size, batch_first=True)
        self.attention = BilinearAttention(hidden_size)
        self.combine = nn.Linear(2 * hidden_size, hidden_size)
        self.output = nn.Linear(hidden_size, embedding.num_embeddings)

    def start(self, encoded: Encoded) -> State:
        """Return the memory before the first token."""
        hidden = torch.tanh(self.bridge(encoded.final))[None]  # [1, batch, hidden]
        return State(hidden, torch.zeros_like(hidden))

    def forward(self, tokens: Tensor, state: State, encoded: Encoded) -> tuple[Tensor, State]:
        """Return logits of the next token after each of ``tokens`` [batch, target length], of shape
        [batch, target length, target words], and the memory after the last."""
        written, state = self.write(tokens, state)
        return self.logits(written, encoded), state

    def write(self, tokens: Tensor, state: State) -> tuple[Tensor, State]:
        """Run the LSTM alone: return its outputs [batch, target length, hidden] and the memory."""
        vectors = self.embedding(tokens)  # [batch, target length, embedding]
        written, (hidden, cell) = self.lstm(vectors, (state.hidden, state.cell))
        return written, State(hidden, cell)

    def logits(self, written: Tensor, encoded: Encoded) -> Tensor:
        """Run attention and the output layer, which follow it. Shapes as above."""
        read = self.attention(written, encoded)  # [batch, target length, hidden]
        joined = torch.cat((written, read), dim=-1)  # [batch, target length, 2 * hidden]
        return self.output(torch.tanh(self.combine(joined)))  # type: ignore[no-any-return]
