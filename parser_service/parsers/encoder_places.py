"""Where pretrained weights lie: a folder, an installed package or the local cache of a hub.

Nothing is downloaded, no package is run and torch is not loaded: pages look here, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

CONFIG = "config.json"
WEIGHTS = "model.safetensors"
TOKENIZERS = ("tokenizer.json", "vocab.txt")

_encoders: Path | None = None
_vectors: Path | None = None


def keep_encoders_in(encoders: Path | None, vectors: Path | None = None) -> None:
    """Says where this installation keeps its encoders (GPSR_ENCODERS_DIR), and where frozen ones may
    leave the vectors of many utterances for the next training."""
    global _encoders, _vectors
    _encoders, _vectors = encoders, vectors


def encoders_folder() -> Path | None:
    """Where this installation keeps its encoders; None where nobody said."""
    return _encoders


def vectors_folder() -> Path | None:
    """Where computed vectors may be left; None where they stay in memory."""
    return _vectors


def find_encoder(name: str, encoders: Path | None = None) -> Path:
    """The folder in which the transformer ``name`` lies, in the files of Hugging Face.

    Args:
        name: a folder, a folder inside ``encoders``, an importable package with the files somewhere
            inside, or the name of a model in the local cache of the Hugging Face hub.
        encoders: where an installation keeps its encoders.

    Raises:
        ValueError: it is at none of these places, or incomplete; says what to put where.
    """
    for folder in _places(name, encoders):
        if (folder / CONFIG).is_file():
            _refuse_incomplete(folder)
            return folder
    there = (encoders or Path("ENCODERS")) / name
    download = f", for example with: hf download {name} --local-dir {there}" if "/" in name else ""
    raise ValueError(
        f"There are no weights of {name}: it is no folder{inside(encoders)}, no installed package "
        f"and not in the cache of the hub. Put its {CONFIG}, {WEIGHTS} and {TOKENIZERS[0]} into "
        f"{there}{download}; or install the package that holds them."
    )


def inside(encoders: Path | None) -> str:
    """Where names of folders were looked for as well, as a part of a sentence."""
    return f" in {encoders}" if encoders else ""


def _places(name: str, encoders: Path | None) -> Iterator[Path]:
    """Where the encoder may lie, in the order in which it is looked for."""
    yield Path(name)
    if encoders is not None:
        yield encoders / name
    yield from _in_package(name)
    yield from _in_cache(name)


def _in_package(name: str) -> Iterator[Path]:
    """The folders of an installed package that hold an encoder; the package is not run."""
    spec = find_spec(name) if name.isidentifier() else None
    for root in (spec.submodule_search_locations or ()) if spec else ():
        for path in sorted(Path(root).rglob(CONFIG)):
            if (path.parent / WEIGHTS).is_file():
                yield path.parent


def _in_cache(name: str) -> Iterator[Path]:
    from huggingface_hub import snapshot_download
    from huggingface_hub.errors import HFValidationError, LocalEntryNotFoundError

    try:
        yield Path(snapshot_download(name, local_files_only=True))
    except (LocalEntryNotFoundError, HFValidationError, OSError):
        return


def _refuse_incomplete(folder: Path) -> None:
    if not (folder / WEIGHTS).is_file():
        pickled = any(folder.glob("*.bin")) or any(folder.glob("*.pt"))
        reason = "only pickled weights, which are never read" if pickled else f"no {WEIGHTS}"
        raise ValueError(f"{folder} holds {reason}. Put {WEIGHTS} of the same model there.")
    if not any((folder / name).is_file() for name in TOKENIZERS):
        raise ValueError(f"{folder} holds no {TOKENIZERS[0]}. Put that of the same model there.")
