"""Published encoder–decoders, from where other pretrained encoders are."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from annotations.language.texts import Refusal
from parser_service.neural.pretrained import read_model, read_or_refused, refuse_gaps
from parser_service.parsers.pretrained_files import TOKENIZERS, find_encoder

if TYPE_CHECKING:
    from tokenizers import Tokenizer
    from transformers import PreTrainedModel


@dataclass(frozen=True, slots=True)
class PretrainedWriter:
    """A published encoder–decoder: its network, and its tokenizer as ``tokenizer.json`` holds it."""

    model: PreTrainedModel
    tokenizer: Tokenizer
    folder: Path


def load_encoder_decoder(name: str, encoders: Path | None = None) -> PretrainedWriter:
    """Load the encoder–decoder ``name`` (T5, FLAN-T5, BART and their like) in single precision, from where
    ``find_encoder`` finds it. Raises Refusal."""
    folder = find_encoder(name, encoders)
    import torch
    from tokenizers import Tokenizer
    from transformers import AutoModelForSeq2SeqLM

    if not (folder / TOKENIZERS[0]).is_file():
        raise Refusal(
            f"{folder} holds no {TOKENIZERS[0]}. Put the one of the same model there.",
            "pretrained_weights_unreadable",
        )
    with read_or_refused(folder, "encoder–decoder"):
        tokenizer = Tokenizer.from_file(str(folder / TOKENIZERS[0]))
        model, report = read_model(AutoModelForSeq2SeqLM, folder, dtype=torch.float32)
    refuse_gaps(folder, report["missing_keys"])
    return PretrainedWriter(model, tokenizer, folder)
