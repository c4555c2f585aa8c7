"""Verb: fetch the published data that figures were measured with, file by file, from the addresses of a list."""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from http.client import HTTPException
from pathlib import Path
from typing import Any
from urllib.error import HTTPError, URLError
from urllib.request import HTTPRedirectHandler, build_opener

PUBLISHED_DATA = Path(__file__).with_name("published_data.toml")
MOST_BYTES = 4 * 1024 * 1024  # of a file; the largest has 0.4 MB
SECONDS = 30  # without a byte


@dataclass(frozen=True, slots=True)
class DataSet:
    """Files below ``url``: name in ``folder`` → what is known of the content. ``by_hand`` is a page for people."""

    folder: str
    url: str
    by_hand: str
    files: Mapping[str, str]


def published_data() -> list[DataSet]:
    """Return what the list names."""
    return [DataSet(**each) for each in tomllib.loads(PUBLISHED_DATA.read_text("utf-8"))["data"]]


def fetch(data_set: DataSet, target: Path) -> Iterator[tuple[Path, str, bool]]:
    """Yield each file below ``target``, what is wrong with it or nothing, and whether it was there already.

    A file that is there is checked, and never replaced. One whose content is not what the list says is not stored.
    Where no connection can be made, the others are not tried.
    """
    unreachable = ""
    for name, known in data_set.files.items():
        path = target / data_set.folder / name
        if path.exists():
            wrong = why_other(path.read_bytes(), known)
            yield path, wrong and f"{wrong}; delete it, and it is fetched anew", True
            continue
        try:
            content = b"" if unreachable else _read(data_set.url + name)
        except HTTPError as error:
            yield path, f"is not at {error.url} ({error.code})", False
            continue
        except (URLError, HTTPException, TimeoutError, ConnectionError) as error:
            unreachable = f"could not be fetched ({getattr(error, 'reason', error)})"
        if unreachable:
            yield path, unreachable, False
            continue
        wrong = why_other(content, known)
        if not wrong:
            path.parent.mkdir(parents=True, exist_ok=True)
            unfinished = path.with_name(f"{path.name}.part")
            unfinished.write_bytes(content)
            unfinished.replace(path)
        yield path, wrong, False


def why_other(content: bytes, known: str) -> str:
    """Say why the content is not what is ``known`` of it (``sha256 HEX``, ``lines N``); empty where it is."""
    if len(content) > MOST_BYTES:
        return f"is over {MOST_BYTES // 1024**2} MB"
    kind, _, wanted = known.partition(" ")
    if kind == "sha256" and hashlib.sha256(content).hexdigest() != wanted:
        return "is not the file that was published (another SHA-256)"
    if kind == "lines" and content.count(b"\n") != int(wanted):
        return f"is not the file that was published ({wanted} lines)"
    return ""


class _NoRedirects(HTTPRedirectHandler):
    """The list names files themselves: an answer that leads elsewhere is none."""

    def redirect_request(self, *request: Any) -> None:
        return None


def _read(url: str) -> bytes:
    with build_opener(_NoRedirects).open(url, timeout=SECONDS) as response:
        content: bytes = response.read(MOST_BYTES + 1)
    return content
