"""A pretrained transformer that gives each text one vector."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Self

import torch
from tokenizers import Tokenizer
from torch import Tensor, nn
from torch.nn.functional import normalize
from transformers import AutoConfig, AutoModel, PreTrainedModel

from parser_service.neural.pretrained import Pretrained
from parser_service.neural.processor import denormals_flushed
from parser_service.neural.shared_dropout import share_dropout
from parser_service.parsers.interface import Check, keep_going

ENCODER = "encoder.json"
TOKENIZER = "tokenizer.json"
LONGEST = 64  # subwords; the longest published paraphrase has 45
LENGTH_STEP = 8  # subwords; torch keeps code for each shape: few of them, less memory
BATCH = 64


class SentenceEncoder(nn.Module):
    """The mean of the last layer's vectors, of length 1 (Reimers and Gurevych 2019).

    Word embeddings keep their pretrained values: a few hundred pairs would move only those of the
    words in them.
    """

    def __init__(self, model: PreTrainedModel, tokenizer: Tokenizer, dropout: float = 0.0):
        super().__init__()
        self.model = model
        self.tokenizer = tokenizer
        self.dropout = nn.Dropout(dropout)
        self.in_bf16 = False
        share_dropout(model)
        model.set_attn_implementation("eager")  # on short texts the fused one takes longer
        tokenizer.enable_truncation(LONGEST)
        tokenizer.enable_padding(
            pad_id=model.config.pad_token_id or 0, pad_to_multiple_of=LENGTH_STEP
        )
        model.get_input_embeddings().weight.requires_grad_(False)

    @classmethod
    def of(cls, pretrained: Pretrained, dropout: float = 0.0) -> Self:
        """A copy of a published encoder, to be trained on."""
        text = pretrained.tokenizer.backend_tokenizer.to_str()
        return cls(pretrained.model, Tokenizer.from_str(text), dropout)

    @classmethod
    def described_in(cls, folder: Path) -> Self:
        """An encoder of the shape that ``describe`` wrote, with arbitrary weights."""
        values = json.loads((folder / ENCODER).read_text(encoding="utf-8"))
        config = AutoConfig.for_model(values.pop("model_type"), **values)
        with torch.random.fork_rng(devices=[]):  # weights are drawn only to be replaced
            model = AutoModel.from_config(config)  # type: ignore[no-untyped-call]
        return cls(model, Tokenizer.from_file(str(folder / TOKENIZER)))

    def describe(self, folder: Path) -> None:
        """Writes what ``described_in`` reads: everything but the weights."""
        (folder / ENCODER).write_text(self.model.config.to_json_string(use_diff=False), "utf-8")
        self.tokenizer.save(str(folder / TOKENIZER))

    @property
    def width(self) -> int:
        return int(self.model.config.hidden_size)

    @property
    def device(self) -> torch.device:
        return self.model.device

    def forward(self, texts: Sequence[str]) -> Tensor:
        """Vectors of length 1. Shape [texts, width], always in single precision."""
        device = self.device
        cut = self.tokenizer.encode_batch(list(texts))
        subwords = torch.tensor([each.ids for each in cut], device=device)  # [texts, length]
        mask = torch.tensor([each.attention_mask for each in cut], device=device)
        bf16 = torch.autocast(device.type, torch.bfloat16) if self.in_bf16 else nullcontext()
        with bf16:
            states = self.model(input_ids=subwords, attention_mask=mask).last_hidden_state
        states = self.dropout(states.float())  # [texts, length, width]
        shares = mask / mask.sum(1, keepdim=True)  # [texts, length]
        return normalize(torch.einsum("bl,blw->bw", shares, states), dim=-1)

    @torch.no_grad()
    @denormals_flushed()
    def vectors(
        self, texts: Sequence[str], check: Check = keep_going, at_once: int = BATCH
    ) -> Tensor:
        """The same without dropout and gradient, for any number of texts. Shape [texts, width].

        Texts of about one length are encoded together, ``at_once`` at a time.
        """
        if not texts:
            return torch.zeros(0, self.width, device=self.device)
        was_training = self.training
        self.eval()
        order = sorted(range(len(texts)), key=lambda index: len(texts[index]))
        found = []
        for begin in range(0, len(order), at_once):
            check()
            found.append(self([texts[index] for index in order[begin : begin + at_once]]))
        self.train(was_training)
        vectors = torch.cat(found)
        return vectors[torch.tensor(order).argsort()]
