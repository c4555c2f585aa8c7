"""BERT (Devlin et al. 2019) without transformers, which takes seconds to import.

Its weights have the names of transformers' ``BertModel``, and its vectors the same bits with the same
weights: every operation is the one that transformers does with eager attention, in the same order,
until its layers are packed (``half_precision``).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, NamedTuple, Self

import torch
from torch import Tensor, nn
from torch.nn.functional import gelu, softmax

from parser_service.neural.sentence_encoder.half_precision import (
    Linear,
    are_few,
    multiply,
    packed,
)

# What transformers' configuration may say and this network does not vary.
FIXED = {
    "hidden_act": "gelu",
    "is_decoder": False,
    "add_cross_attention": False,
    "chunk_size_feed_forward": 0,
    "dtype": "float32",
}


class SharedDropout(nn.Dropout):
    """Drops the same features of every word of a text (Gal and Ghahramani 2016).

    Drawing one for each word as well, as usual, takes a sixth of a training step on a CPU.
    """

    def forward(self, values: Tensor) -> Tensor:
        """Return ``values`` [texts, ..., features] with some features set to 0."""
        if not self.training or not self.p:
            return values
        kept = values.new_empty(len(values), *[1] * (values.dim() - 2), values.shape[-1])
        return values * (kept.bernoulli_(1 - self.p) / (1 - self.p))


def share_dropout(network: nn.Module) -> None:
    """Replace every dropout layer of ``network`` by one of this kind with the same rate."""
    for module in [*network.modules()]:
        for name, layer in module.named_children():
            if type(layer) is nn.Dropout:
                setattr(module, name, SharedDropout(layer.p))


@dataclass(frozen=True, slots=True)
class BertConfig:
    """The shape of a network, under the names that transformers gives its parts."""

    vocab_size: int
    hidden_size: int
    num_hidden_layers: int
    num_attention_heads: int
    intermediate_size: int
    max_position_embeddings: int
    type_vocab_size: int
    layer_norm_eps: float
    hidden_dropout_prob: float
    attention_probs_dropout_prob: float
    pad_token_id: int | None

    @classmethod
    def read(cls, description: Mapping[str, Any]) -> Self:
        """Read a configuration that transformers wrote in full."""
        return cls(**{field.name: description[field.name] for field in fields(cls)})


class States(NamedTuple):
    """What ``Bert`` returns, under the name that transformers gives it."""

    last_hidden_state: Tensor  # [texts, length, width]


class Embedding(nn.Embedding):
    """Has uninitialised memory for weights, as ``Linear`` has."""

    def reset_parameters(self) -> None:
        pass


class Bert(nn.Module):
    """Encodes subwords in their context. It starts without weights: load them.

    Dropout drops the same features of every word of a text, but for that of attention.
    """

    def __init__(self, config: BertConfig):
        super().__init__()
        self.config = config
        self.embeddings = Embeddings(config)
        self.encoder = Layers(config)
        self.pooler = Pooler(config)

    def get_input_embeddings(self) -> nn.Embedding:
        return self.embeddings.word_embeddings

    def pack(self) -> None:
        """Get ready to answer: the weights do not change any more."""
        for layer in self.encoder.layer:
            assert isinstance(layer, Layer)
            layer.attention.self.pack()
            for part in (layer.attention.output, layer.intermediate, layer.output):
                part.dense.pack()

    def forward(self, input_ids: Tensor, attention_mask: Tensor) -> States:
        """Encode ``input_ids`` [texts, length]; ``attention_mask``, of the same shape, is 0 at padding."""
        states = self.embeddings(input_ids)
        return States(self.encoder(states, attention_bias(attention_mask, states.dtype)))


class Embeddings(nn.Module):
    """The sum of the vectors of a subword, of its place and of the first type of text."""

    def __init__(self, config: BertConfig):
        super().__init__()
        width = config.hidden_size
        self.word_embeddings = Embedding(config.vocab_size, width)
        self.position_embeddings = Embedding(config.max_position_embeddings, width)
        self.token_type_embeddings = Embedding(config.type_vocab_size, width)
        self.LayerNorm = nn.LayerNorm(width, eps=config.layer_norm_eps)
        self.dropout = SharedDropout(config.hidden_dropout_prob)

    def forward(self, subwords: Tensor) -> Tensor:
        """Return states [texts, length, width]."""
        places = torch.arange(subwords.shape[1], device=subwords.device)[None]
        types = torch.zeros_like(subwords)
        states = self.word_embeddings(subwords) + self.token_type_embeddings(types)
        states = states + self.position_embeddings(places)
        dropped: Tensor = self.dropout(self.LayerNorm(states))
        return dropped


class SelfAttention(nn.Module):
    """Scaled dot-product attention of several heads (Vaswani et al. 2017)."""

    _packed: Any = None  # query, key and value: one product takes less time than three

    def __init__(self, config: BertConfig):
        super().__init__()
        width = config.hidden_size
        self.head_width = width // config.num_attention_heads
        self.query = Linear(width, width)
        self.key = Linear(width, width)
        self.value = Linear(width, width)
        self.dropout = nn.Dropout(config.attention_probs_dropout_prob)

    def pack(self) -> None:
        layers = self.query, self.key, self.value
        weights, biases = (each.weight for each in layers), (each.bias for each in layers)
        self._packed = packed(torch.cat([*weights]), torch.cat([*biases]))

    def forward(self, states: Tensor, bias: Tensor | None) -> Tensor:
        """Return states [texts, length, width]."""
        shape = *states.shape[:2], -1, self.head_width
        if self._packed is not None and are_few(states):
            projected = multiply(states, self._packed).chunk(3, -1)
        else:
            projected = self.query(states), self.key(states), self.value(states)
        # [texts, heads, length, head width] each
        query, key, value = (each.view(shape).transpose(1, 2) for each in projected)
        scores = torch.matmul(query, key.transpose(2, 3)) * self.head_width**-0.5
        if bias is not None:
            scores = scores + bias
        shares = self.dropout(softmax(scores, dim=-1))  # [texts, heads, length, length]
        mixed = torch.matmul(shares, value).transpose(1, 2).contiguous()
        return mixed.reshape(*states.shape[:2], -1)


class Residual(nn.Module):
    """A linear layer, added to what came before it and normalised."""

    def __init__(self, config: BertConfig, width: int):
        super().__init__()
        self.dense = Linear(width, config.hidden_size)
        self.LayerNorm = nn.LayerNorm(config.hidden_size, eps=config.layer_norm_eps)
        self.dropout = SharedDropout(config.hidden_dropout_prob)

    def forward(self, states: Tensor, before: Tensor) -> Tensor:
        states = self.dropout(self.dense(states)) + before
        normalised: Tensor = self.LayerNorm(states)
        return normalised


class Attention(nn.Module):
    """The first half of a layer."""

    def __init__(self, config: BertConfig):
        super().__init__()
        self.self = SelfAttention(config)
        self.output = Residual(config, config.hidden_size)

    def forward(self, states: Tensor, bias: Tensor | None) -> Tensor:
        attended: Tensor = self.output(self.self(states, bias), states)
        return attended


class Intermediate(nn.Module):
    """The wide part of the second half."""

    def __init__(self, config: BertConfig):
        super().__init__()
        self.dense = Linear(config.hidden_size, config.intermediate_size)

    def forward(self, states: Tensor) -> Tensor:
        return gelu(self.dense(states))


class Layer(nn.Module):
    """Attention between the subwords of a text, then two linear layers for each of them."""

    def __init__(self, config: BertConfig):
        super().__init__()
        self.attention = Attention(config)
        self.intermediate = Intermediate(config)
        self.output = Residual(config, config.intermediate_size)

    def forward(self, states: Tensor, bias: Tensor | None) -> Tensor:
        states = self.attention(states, bias)
        states = self.output(self.intermediate(states), states)
        return states


class Layers(nn.Module):
    """All layers, one after the other."""

    def __init__(self, config: BertConfig):
        super().__init__()
        self.layer = nn.ModuleList(Layer(config) for _ in range(config.num_hidden_layers))

    def forward(self, states: Tensor, bias: Tensor | None) -> Tensor:
        for layer in self.layer:
            states = layer(states, bias)
        return states


class Pooler(nn.Module):
    """The weights of a layer that published files hold and nothing here reads."""

    def __init__(self, config: BertConfig):
        super().__init__()
        self.dense = Linear(config.hidden_size, config.hidden_size)


def is_bert(description: Mapping[str, Any]) -> bool:
    """Return whether ``Bert`` is the network that a configuration of transformers describes."""
    return description.get("model_type") == "bert" and all(
        description.get(name) in (None, value) for name, value in FIXED.items()
    )


def attention_bias(attention_mask: Tensor, dtype: torch.dtype) -> Tensor | None:
    """Return what to add to the scores of attention, so that nothing attends to padding.

    Shape [texts, 1, 1, length]; None where no text is padded: in bf16, adding zeros would change the
    precision of what follows.
    """
    is_word = attention_mask.bool()[:, None, None]
    if is_word.all():
        return None
    return torch.where(
        is_word, torch.zeros((), dtype=dtype, device=is_word.device), torch.finfo(dtype).min
    )
