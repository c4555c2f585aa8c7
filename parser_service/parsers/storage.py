"""A saved parser: files in one folder, and a ``config.json`` with their hashes."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from hashlib import file_digest
from http import HTTPStatus
from pathlib import Path
from typing import Any

from annotations.language.texts import Refusal
from parser_service.parsers.hyperparameters.fields import read_config
from parser_service.parsers.interface import Parser

CONFIG = "config.json"


@dataclass(frozen=True, slots=True)
class Saved:
    """What ``config.json`` says about a parser."""

    config: Any
    seed: int


def write_json(path: Path, value: Any) -> None:
    """Write ``value`` so that equal values give equal bytes."""
    text = json.dumps(value, ensure_ascii=False, indent=1)
    path.write_text(text + "\n", encoding="utf-8")


def read_json(path: Path) -> Any:
    """Read a JSON file. Raises Refusal where it is absent or holds something else."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise Refusal(
            f"{path} is missing: the parser in this folder is incomplete.",
            "saved_file_missing",
            HTTPStatus.CONFLICT,
        ) from None
    except (ValueError, RecursionError):  # not UTF-8, not JSON, or nested without end
        raise Refusal(
            f"{path} is not a JSON file; train the parser again.",
            "saved_parser_unreadable",
            HTTPStatus.CONFLICT,
        ) from None


def seal(folder: Path, parser: Parser, files: Sequence[str]) -> None:
    """Write ``config.json`` beside ``files``, which are there already."""
    hashes = {name: file_hash(folder / name) for name in files}
    about = {"parser": parser.name, "version": parser.version, "seed": parser.seed}
    write_json(folder / CONFIG, {**about, "config": asdict(parser.config), "sha256": hashes})


def open_sealed(folder: Path, parser: type[Parser], files: Sequence[str]) -> Saved:
    """Read what ``seal`` wrote, after checking that ``files`` have the bytes that were saved.

    Raises Refusal where the folder holds another parser, a version of this one that it
    does not read, or a file that is missing or was altered.
    """
    about = read_json(folder / CONFIG)
    try:
        name, version = about["parser"], about["version"]
        hashes, config, seed = dict(about["sha256"]), dict(about["config"]), int(about["seed"])
    except (KeyError, TypeError, ValueError):
        raise Refusal(
            f"{folder / CONFIG} does not describe a parser.",
            "saved_parser_unreadable",
            HTTPStatus.CONFLICT,
        ) from None
    if name != parser.name or version not in (parser.version, *parser.reads):
        raise Refusal(
            f"{folder} holds version {version} of {name}, not version {parser.version} of "
            f"{parser.name}; train it again.",
            "other_parser_version",
            HTTPStatus.CONFLICT,
        )
    for file in files:
        path = folder / file
        if not path.is_file():
            raise Refusal(
                f"{path} is missing: the parser in this folder is incomplete.",
                "saved_file_missing",
                HTTPStatus.CONFLICT,
            )
        if file_hash(path) != hashes.get(file):
            raise Refusal(
                f"{path} is not the file that was saved: its SHA-256 differs from the one in "
                f"{CONFIG}. Copy the folder again, or train the parser again.",
                "saved_file_altered",
                HTTPStatus.CONFLICT,
            )
    return Saved(read_config(parser.Config, config), seed)


def file_hash(path: Path) -> str:
    """Return the SHA-256 of a file, in hexadecimal."""
    with path.open("rb") as stream:
        return file_digest(stream, "sha256").hexdigest()
