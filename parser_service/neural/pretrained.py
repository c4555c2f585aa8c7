"""Pretrained encoders: from a folder, an installed package or the cache of a hub, in that order.

Nothing is downloaded, only safetensors are read, and no code that comes with weights is run.
"""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from transformers import AutoModel, AutoTokenizer, PreTrainedModel, PreTrainedTokenizerFast

from parser_service.parsers.encoder_places import CONFIG, TOKENIZERS, WEIGHTS, find_encoder
from parser_service.parsers.storage import file_hash


@dataclass(frozen=True, slots=True)
class Pretrained:
    """An encoder as it was published: its network and how it cuts texts into subwords."""

    model: PreTrainedModel
    tokenizer: PreTrainedTokenizerFast  # the one with a Rust core
    folder: Path


def load_encoder(name: str, encoders: Path | None = None) -> Pretrained:
    """The encoder ``name``, found as by ``find_encoder``. Raises ValueError, a sentence."""
    folder = find_encoder(name, encoders)
    try:
        tokenizer = AutoTokenizer.from_pretrained(
            folder, local_files_only=True, trust_remote_code=False
        )
        model = AutoModel.from_pretrained(
            folder, local_files_only=True, trust_remote_code=False, use_safetensors=True
        )
    except Exception as problem:  # transformers raises whatever its parts raise
        text = " ".join(str(problem).split())[:200]
        raise ValueError(f"{folder} holds no encoder that can be read: {text}") from problem
    if not isinstance(tokenizer, PreTrainedTokenizerFast):
        raise ValueError(f"{folder} holds no tokenizer.json that can be read. Put that file there.")
    return Pretrained(model, tokenizer, folder)


def encoder_hash(folder: Path) -> str:
    """The SHA-256 of what decides an encoder's vectors: configuration, weights and subwords."""
    names = (CONFIG, WEIGHTS, *TOKENIZERS)
    hashes = [f"{name} {file_hash(folder / name)}" for name in names if (folder / name).is_file()]
    return sha256("\n".join(hashes).encode()).hexdigest()
