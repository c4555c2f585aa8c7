"""A saved parser: files in one folder under a ``config.json`` that has their hashes."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from parser_service.parsers.config_fields import read_config
from parser_service.parsers.interface import Parser

CONFIG = "config.json"


@dataclass(frozen=True, slots=True)
class Saved:
    """What ``config.json`` says about a parser."""

    config: Any
    seed: int


def write_json(path: Path, value: Any) -> None:
    """Writes ``value`` so that equal values give equal bytes."""
    text = json.dumps(value, ensure_ascii=False, indent=1)
    path.write_text(text + "\n", encoding="utf-8")


def read_json(path: Path) -> Any:
    """The value in a JSON file. Raises ValueError where it is absent or holds something else."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ValueError(f"{path} is missing: this folder holds no complete parser.") from None
    except ValueError:  # not UTF-8, or not JSON
        raise ValueError(f"{path} is not a JSON file; save the parser again.") from None


def seal(folder: Path, parser: Parser, files: Sequence[str]) -> None:
    """Writes ``config.json`` beside ``files``, which are there already."""
    hashes = {name: file_hash(folder / name) for name in files}
    about = {"parser": parser.name, "version": parser.version, "seed": parser.seed}
    write_json(folder / CONFIG, {**about, "config": asdict(parser.config), "sha256": hashes})


def open_sealed(folder: Path, parser: type[Parser], files: Sequence[str]) -> Saved:
    """What ``seal`` wrote, after checking that ``files`` are the bytes that were saved.

    Raises ValueError, a sentence, where the folder holds another parser, another version of this
    one, or a file that is missing or was altered.
    """
    about = read_json(folder / CONFIG)
    try:
        found = (about["parser"], about["version"])
        hashes, config, seed = dict(about["sha256"]), dict(about["config"]), int(about["seed"])
    except (KeyError, TypeError, ValueError):
        raise ValueError(f"{folder / CONFIG} does not describe a parser.") from None
    if found != (parser.name, parser.version):
        raise ValueError(
            f"{folder} holds version {found[1]} of {found[0]}, not version {parser.version} of "
            f"{parser.name}; train it again."
        )
    for name in files:
        _verify(folder / name, hashes.get(name))
    return Saved(read_config(parser.Config, config), seed)


def file_hash(path: Path) -> str:
    """The SHA-256 of a file, in hexadecimal."""
    digest = sha256()
    with path.open("rb") as stream:
        while block := stream.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def _verify(path: Path, expected: str | None) -> None:
    if not path.is_file():
        raise ValueError(f"{path} is missing: this folder holds no complete parser.")
    if file_hash(path) != expected:
        raise ValueError(
            f"{path} is not the file that was saved: its SHA-256 differs from the one in "
            f"{CONFIG}. Copy the folder again or train the parser again."
        )
