"""Pretrained encoders from a folder, an installed package or the cache of a hub.

Nothing is downloaded, only safetensors are read, and no code that comes with weights is run.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from annotations.language.texts import Refusal
from parser_service.parsers.pretrained_files import (
    CONFIG,
    TOKENIZERS,
    WEIGHTS,
    find_encoder,
    refuse_other_weights,
)
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
    """Load the encoder ``name``, from where ``find_encoder`` finds it. Raises Refusal."""
    folder = find_encoder(name, encoders)
    refuse_other_weights(name, folder)
    # Importing it takes seconds, and a saved ranker answers without it.
    from transformers import AutoModel, AutoTokenizer, PreTrainedTokenizerFast

    with read_or_refused(folder, "encoder"):
        tokenizer = AutoTokenizer.from_pretrained(
            folder, local_files_only=True, trust_remote_code=False
        )
        model, report = read_model(AutoModel, folder)
    if not isinstance(tokenizer, PreTrainedTokenizerFast):
        raise Refusal(
            f"{folder} holds no tokenizer.json that can be read. Put that file there.",
            "pretrained_weights_unreadable",
        )
    refuse_gaps(folder, report["missing_keys"])
    return Pretrained(model, tokenizer, folder)


def read_model(
    factory: Any, folder: Path, **options: Any
) -> tuple[PreTrainedModel, dict[str, Collection[str]]]:
    """Return the network in ``folder``, and which weights its file lacks, among others."""
    from transformers.utils import logging

    # What matters in a load report is raised later; the rest and the bars would fill the log of a run.
    logging.disable_progress_bar()  # type: ignore[no-untyped-call]
    logging.set_verbosity_error()  # type: ignore[no-untyped-call]
    model, report = factory.from_pretrained(
        folder,
        local_files_only=True,
        trust_remote_code=False,
        use_safetensors=True,
        output_loading_info=True,
        **options,
    )
    return model, report


@contextmanager
def read_or_refused(folder: Path, what: str) -> Iterator[None]:
    """Make a Refusal of whatever transformers and its parts raise inside the block."""
    try:
        yield
    except Exception as error:
        text = " ".join(str(error).split())[:200]
        raise Refusal(
            f"{folder} holds no {what} that can be read: {text}", "pretrained_weights_unreadable"
        ) from error


def encoder_hash(folder: Path) -> str:
    """Return the SHA-256 of what decides an encoder's vectors: configuration, weights and tokenizer."""
    names = (CONFIG, WEIGHTS, *TOKENIZERS)
    hashes = [f"{name} {file_hash(folder / name)}" for name in names if (folder / name).is_file()]
    return sha256("\n".join(hashes).encode()).hexdigest()


def refuse_gaps(folder: Path, absent: Collection[str]) -> None:
    """Refuse a file without all weights: transformers would draw them at random without a word. Raises
    Refusal."""
    used = sorted(name for name in absent if not name.startswith(UNUSED))
    if used:
        raise Refusal(
            f"{folder / WEIGHTS} lacks {len(used)} weights of the network that its {CONFIG} "
            f"describes, {used[0]} first. Put the two files of one model there.",
            "pretrained_weights_unreadable",
        )
