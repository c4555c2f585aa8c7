"""A pretrained transformer that encodes each text as one vector: ``Bert``, or what else transformers knows.

Transformers is imported for the latter alone: that takes longer than all else that answering does.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import torch
from tokenizers import Tokenizer
from torch import Tensor, nn
from torch.nn.functional import normalize

from annotations.language.texts import Refusal
from parser_service.neural.device import denormals_flushed
from parser_service.neural.pretrained import Pretrained
from parser_service.neural.sentence_encoder.bert import Bert, BertConfig, is_bert, share_dropout
from parser_service.parsers.interface import Check, keep_going
from parser_service.parsers.storage import read_json

if TYPE_CHECKING:
    from transformers import PreTrainedModel

    Network = Bert | PreTrainedModel

ENCODER = "encoder.json"
TOKENIZER = "tokenizer.json"
LONGEST = 64  # subwords; the longest published paraphrase has 45
# Subwords. In bf16 torch keeps code for each shape, so fewer shapes need less memory.
BF16_LENGTH_STEP = 8
# Texts that are padded to the longest of them. A CPU reads padding as slowly as words, so there are fewer.
TOGETHER, TOGETHER_ON_CPU = 64, 16


class SentenceEncoder(nn.Module):
    """The mean of the last layer's vectors, of length 1 (Reimers and Gurevych 2019).

    Word embeddings keep their pretrained values: a few hundred pairs would change only those of the
    words in them.
    """

    def __init__(
        self,
        model: Network,
        description: Mapping[str, Any],
        tokenizer: Tokenizer,
        dropout: float = 0.0,
    ):
        """``description`` is that of ``model``, as ``describe`` returns and ``make_empty`` reads it."""
        super().__init__()
        self.model = model
        self.description = description
        self.tokenizer = tokenizer
        self.dropout = nn.Dropout(dropout)
        self.in_bf16 = False
        tokenizer.enable_truncation(LONGEST)
        tokenizer.no_padding()
        model.get_input_embeddings().weight.requires_grad_(False)

    @classmethod
    def of(cls, pretrained: Pretrained, dropout: float = 0.0, frozen_layers: int = 0) -> Self:
        """Make a copy of a published encoder, trainable but for its lowest ``frozen_layers``.

        Raises Refusal where it has no layer above them.
        """
        text = pretrained.tokenizer.backend_tokenizer.to_str()
        model = pretrained.model
        network = make_trainable(model)
        if frozen_layers:
            freeze(network, frozen_layers)
        return cls(network, describe(model), Tokenizer.from_str(text), dropout)

    @classmethod
    def described_in(cls, folder: Path) -> Self:
        """Return an encoder of the shape that ``describe`` wrote. Its weights are uninitialised memory."""
        description = read_json(folder / ENCODER)
        tokenizer = Tokenizer.from_file(str(folder / TOKENIZER))
        return cls(make_empty(description), description, tokenizer)

    def describe(self, folder: Path) -> None:
        """Write what ``described_in`` reads: everything but the weights."""
        text = json.dumps(self.description, indent=2, sort_keys=True)
        (folder / ENCODER).write_text(f"{text}\n", encoding="utf-8")
        self.tokenizer.save(str(folder / TOKENIZER))

    def pack(self) -> None:
        """Get ready to answer: the weights do not change any more."""
        if isinstance(self.model, Bert):
            self.model.pack()

    @property
    def width(self) -> int:
        return int(self.model.config.hidden_size)

    @property
    def device(self) -> torch.device:
        return next(self.model.parameters()).device

    def cut(self, texts: Sequence[str]) -> list[bool]:
        """Return for each text whether it is longer than this encoder reads."""
        return [bool(each.overflowing) for each in self.tokenizer.encode_batch(list(texts))]

    def forward(self, texts: Sequence[str], check: Check = keep_going) -> Tensor:
        """Return vectors of length 1 [texts, width], always in single precision; 0 for a text without a
        subword. Texts of similar length go through the network together."""
        read = [each.ids for each in self.tokenizer.encode_batch(list(texts))]
        order = sorted(range(len(read)), key=lambda index: len(read[index]))
        together = TOGETHER_ON_CPU if self.device.type == "cpu" else TOGETHER
        vectors = []
        for begin in range(0, len(order), together):
            check()
            vectors.append(self._encode([read[index] for index in order[begin : begin + together]]))
        return torch.cat(vectors)[torch.tensor(order, device=self.device).argsort()]

    def _encode(self, read: Sequence[Sequence[int]]) -> Tensor:
        """Return the vectors of the texts whose subwords are given, padded to the longest."""
        device, longest = self.device, max(1, *map(len, read))
        if self.in_bf16:
            longest += -longest % BF16_LENGTH_STEP
        filler = self.model.config.pad_token_id or 0
        rows = [[*ids, *[filler] * (longest - len(ids))] for ids in read]
        subwords = torch.tensor(rows, dtype=torch.long, device=device)  # [texts, length]
        lengths = torch.tensor([len(ids) for ids in read], device=device)
        mask = (torch.arange(longest, device=device) < lengths[:, None]).long()
        bf16 = torch.autocast(device.type, torch.bfloat16) if self.in_bf16 else nullcontext()
        with bf16:
            states = self.model(input_ids=subwords, attention_mask=mask).last_hidden_state
        states = self.dropout(states.float())  # [texts, length, width]
        shares = mask / mask.sum(1, keepdim=True).clamp(min=1)  # [texts, length]
        return normalize(torch.einsum("bl,blw->bw", shares, states), dim=-1)

    @torch.no_grad()
    @denormals_flushed()
    def vectors(self, texts: Sequence[str], check: Check = keep_going) -> Tensor:
        """Return the vectors of any number of texts without dropout and gradient. Shape [texts, width]."""
        if not texts:
            return torch.zeros(0, self.width, device=self.device)
        was_training = self.training
        if was_training:  # going through all modules takes as long as a part of a short text
            self.eval()
        vectors: Tensor = self(texts, check)
        if was_training:
            self.train()
        return vectors


def describe(model: PreTrainedModel) -> dict[str, Any]:
    """Return the whole configuration of a network, ready for JSON."""
    description: dict[str, Any] = json.loads(model.config.to_json_string(use_diff=False))
    return description


def make_trainable(model: PreTrainedModel) -> Network:
    """Return a network with the weights of ``model`` to train, which may be ``model`` itself."""
    description = describe(model)
    if not is_bert(description):
        return _prepare(model)
    network = Bert(BertConfig.read(description))
    network.load_state_dict(model.state_dict())
    return network


def freeze(network: Network, layers: int) -> None:
    """Keep the embeddings and the lowest ``layers`` as they are: training then follows no gradient into them.

    Raises Refusal where ``network`` has no layer above them.
    """
    number = network.config.num_hidden_layers
    if layers >= number:
        raise Refusal(
            f"frozen_layers is {layers}, but the encoder has {number} layers. Leave one to be trained.",
            "hyperparameter_out_of_range",
        )
    stack = next(
        part
        for part in network.modules()
        if isinstance(part, nn.ModuleList) and len(part) == number
    )
    network.requires_grad_(False)
    stack[layers:].requires_grad_(True)


def make_empty(description: Mapping[str, Any]) -> Network:
    """Return the network that ``describe`` described. Its weights are uninitialised memory."""
    if is_bert(description):
        return Bert(BertConfig.read(description))
    from transformers import AutoConfig, AutoModel
    from transformers.initialization import no_init_weights

    values = dict(description)
    config = AutoConfig.for_model(values.pop("model_type"), **values)
    with no_init_weights():
        model = AutoModel.from_config(config)  # type: ignore[no-untyped-call]
    return _prepare(model)


def _prepare(model: PreTrainedModel) -> PreTrainedModel:
    share_dropout(model)
    model.set_attn_implementation("eager")  # on short texts the fused one takes longer
    return model
