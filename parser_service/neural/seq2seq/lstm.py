"""The network of Walker et al. 2019: an LSTM reads the utterance, another one with attention writes the form."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn
from torch.nn.functional import cross_entropy
from torch.nn.utils.rnn import pack_padded_sequence, pad_packed_sequence

from parser_service.neural.device import bf16_on_gpu
from parser_service.neural.seq2seq.batches import Batch
from parser_service.neural.seq2seq.vocabulary import PADDING
from parser_service.neural.word_vectors.scalar_mix import ContextShape, ScalarMix
from parser_service.parsers.hyperparameters.seq2seq import Seq2SeqConfig


class WordEmbedding(nn.Embedding):
    """A learned vector for each word; that of padding stays zero."""

    def __init__(self, words: int, size: int):
        super().__init__(words, size, padding_idx=PADDING)


class Dropout(nn.Module):
    """Inverted dropout. Its masks come from ``generator`` and not from torch's global one, so that
    nothing else in the process changes what is learned. The generator is on the CPU, so that the
    masks are the same on every processor."""

    def __init__(self, probability: float, generator: torch.Generator):
        super().__init__()
        self.probability = probability
        self.generator = generator

    def forward(self, values: Tensor) -> Tensor:
        if not self.training or self.probability == 0:
            return values
        keep = 1 - self.probability
        mask = torch.empty_like(values, device="cpu").bernoulli_(keep, generator=self.generator)
        return values * mask.to(values.device) / keep  # as values


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


class BilinearAttention(nn.Module):
    """Weights softmax(q W kᵀ) (Luong et al. 2015, "general")."""

    def __init__(self, hidden_size: int):
        super().__init__()
        self.weight = nn.Linear(hidden_size, hidden_size, bias=False)

    def forward(self, queries: Tensor, encoded: Encoded) -> Tensor:
        """Return the attended states for ``queries`` [batch, target length, hidden], of the same shape."""
        keys = encoded.states.transpose(1, 2)  # [batch, hidden, source length]
        scores = torch.bmm(self.weight(queries), keys)  # [batch, target length, source length]
        scores = scores.masked_fill(~encoded.mask[:, None, :], float("-inf"))
        weights = torch.softmax(scores, dim=-1)  # [batch, target length, source length]
        return torch.bmm(weights, encoded.states)  # [batch, target length, hidden]


@dataclass(frozen=True, slots=True)
class LstmState:
    """The memory of the decoder between two tokens."""

    hidden: Tensor  # [1, batch, hidden]
    cell: Tensor  # [1, batch, hidden]

    def rows(self, indices: Tensor) -> LstmState:
        """Return the memory of the chosen rows; ``indices`` [rows]."""
        return LstmState(self.hidden[:, indices], self.cell[:, indices])


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

    def start(self, encoded: Encoded) -> LstmState:
        """Return the memory before the first token."""
        hidden = torch.tanh(self.bridge(encoded.final))[None]  # [1, batch, hidden]
        return LstmState(hidden, torch.zeros_like(hidden))

    def forward(
        self, tokens: Tensor, state: LstmState, encoded: Encoded
    ) -> tuple[Tensor, LstmState]:
        """Return logits of the next token after each of ``tokens`` [batch, target length], of shape
        [batch, target length, target words], and the memory after the last."""
        written, state = self.write(tokens, state)
        return self.logits(written, encoded), state

    def write(self, tokens: Tensor, state: LstmState) -> tuple[Tensor, LstmState]:
        """Run the LSTM alone: return its outputs [batch, target length, hidden] and the memory."""
        vectors = self.embedding(tokens)  # [batch, target length, embedding]
        written, (hidden, cell) = self.lstm(vectors, (state.hidden, state.cell))
        return written, LstmState(hidden, cell)

    def logits(self, written: Tensor, encoded: Encoded) -> Tensor:
        """Run attention and the output layer, which follow it. Shapes as above."""
        read = self.attention(written, encoded)  # [batch, target length, hidden]
        joined = torch.cat((written, read), dim=-1)  # [batch, target length, 2 * hidden]
        return self.output(torch.tanh(self.combine(joined)))  # type: ignore[no-any-return]


class Seq2SeqModel(nn.Module):
    """Bidirectional LSTM encoder, bilinear attention, LSTM decoder (Walker et al. 2019)."""

    def __init__(
        self,
        config: Seq2SeqConfig,
        source_words: int,
        target_words: int,
        generator: torch.Generator,
        context: ContextShape | None = None,
    ):
        """Draw weights and dropout from ``generator`` alone. ``context`` is the shape of what a frozen
        encoder adds to each word of the utterance, if there is one."""
        super().__init__()
        # Torch's layers draw weights from the global generator; they are drawn again below.
        with torch.random.fork_rng(devices=[]):
            source = WordEmbedding(source_words, config.embedding_size)
            target = WordEmbedding(target_words, config.embedding_size)
            mix = ScalarMix(context) if context else None
            dropout = Dropout(config.dropout, generator)
            self.encoder = Encoder(source, config.hidden_size, dropout, mix)
            self.decoder = Decoder(target, config.hidden_size)
        self._draw_weights(generator)

    def loss(self, batch: Batch) -> Tensor:
        """Return the cross entropy in nats per token, a scalar.

        On a GPU attention and output are in bf16. The LSTMs are not: torch would run them in fp16,
        in which small gradients vanish.
        """
        encoded = self.encoder(batch.source, batch.lengths, batch.context)
        device = encoded.states.device
        start = self.decoder.start(encoded)
        written, _ = self.decoder.write(batch.inputs.to(device), start)
        with bf16_on_gpu(device):
            logits = self.decoder.logits(written, encoded)  # [batch, target length, words]
        outputs = batch.outputs.to(device)
        return cross_entropy(logits.float().flatten(0, 1), outputs.flatten(), ignore_index=PADDING)

    @torch.no_grad()
    def _draw_weights(self, generator: torch.Generator) -> None:
        """Draw matrices by Glorot and word vectors from a narrow normal distribution. Biases are 0, and 1 for
        the forget gates, so that an untrained memory keeps what it reads."""
        for name, weights in self.named_parameters():
            if ".mix." in name:
                continue  # starts as the plain mean of the layers
            if "embedding" in name:
                weights.normal_(0, 0.1, generator=generator)
                weights[PADDING] = 0
            elif weights.dim() > 1:
                nn.init.xavier_uniform_(weights, generator=generator)
            else:
                weights.zero_()
                if ".bias_ih" in name:
                    weights[len(weights) // 4 : len(weights) // 2] = 1  # order: in, forget, …
