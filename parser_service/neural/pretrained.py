"""Pretrained encoders from a folder, an installed package or the cache of a hub.

Nothing is downloaded, only safetensors are read, and no code that comes with weights is run.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

from parser_service.parsers.encoder_places import CONFIG, TOKENIZERS, WEIGHTS, find_encoder
from parser_service.parsers.storage import file_hash

if TYPE_CHECKING:
    from transformers import PreTrainedModel, PreTrainedTokenizerFast

UNUSED = "pooler."  # a layer above the last one, which nothing here reads


@dataclass(frozen=True, slots=True)
class Pretrained:
    """A published encoder: its network and its tokenizer."""

    model: PreTrainedModel
    tokenizer: PreTrainedTokenizerFast  # the one with a Rust core
    folder: Path


def load_encoder(name: str, encoders: Path | None = None) -> Pretrained:
    """Load the encoder ``name``, from where ``find_encoder`` finds it. Raises ValueError, a sentence."""
    folder = find_encoder(name, encoders)
    # Importing it takes seconds, and a saved ranker answers without it.
    from transformers import AutoModel, AutoTokenizer, PreTrainedTokenizerFast
    from transformers.utils import logging

    # What matters in a load report is raised below; the rest and the bars would fill the log of a run.
    logging.disable_progress_bar()  # type: ignore[no-untyped-call]
    logging.set_verbosity_error()  # type: ignore[no-untyped-call]
    try:
        tokenizer = AutoTokenizer.from_pretrained(
            folder, local_files_only=True, trust_remote_code=False
        )
        model, report = AutoModel.from_pretrained(
            folder,
            local_files_only=True,
            trust_remote_code=False,
            use_safetensors=True,
            output_loading_info=True,
        )
    except Exception as error:  # transformers raises whatever its parts raise
        text = " ".join(str(error).split())[:200]
        raise ValueError(f"{folder} holds no encoder that can be read: {text}") from error
    if not isinstance(tokenizer, PreTrainedTokenizerFast):
        raise ValueError(f"{folder} holds no tokenizer.json that can be read. Put that file there.")
    _refuse_gaps(folder, report["missing_keys"])
    return Pretrained(model, tokenizer, folder)


def encoder_hash(folder: Path) -> str:
    """Return the SHA-256 of what decides an encoder's vectors: configuration, weights and tokenizer."""
    names = (CONFIG, WEIGHTS, *TOKENIZERS)
    hashes = [f"{name} {file_hash(folder / name)}" for name in names if (folder / name).is_file()]
    return sha256("\n".join(hashes).encode()).hexdigest()


def _refuse_gaps(folder: Path, absent: Collection[str]) -> None:
    """Refuse a file without all weights: transformers would draw them at random without a word. Raises
    ValueError, a sentence."""
    used = sorted(name for name in absent if not name.startswith(UNUSED))
    if used:
        raise ValueError(
            f"{folder / WEIGHTS} lacks {len(used)} weights of the network that its {CONFIG} "
            f"describes, {used[0]} first. Put the two files of one model there."
        )
