"""The network: encoder and decoder with attention, and its loss."""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn.functional import cross_entropy

from parser_service.neural.device import bf16_on_gpu
from parser_service.neural.seq2seq.batches import Batch
from parser_service.neural.seq2seq.decoder import Decoder
from parser_service.neural.seq2seq.embeddings import Dropout, WordEmbedding
from parser_service.neural.seq2seq.encoder import Encoder
from parser_service.neural.seq2seq.vocabulary import PADDING
from parser_service.neural.word_vectors.scalar_mix import ContextShape, ScalarMix
from parser_service.parsers.hyperparameters.seq2seq import Seq2SeqConfig


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
        with torch.random.fork_rng(
            devices=[]
        ):  # torch's layers draw weights, which are drawn again
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
