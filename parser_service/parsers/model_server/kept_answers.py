"""Answers of language models that came already, as files that several processes share.

A file is named by a hash of the question, and holds the answer and the model's name: neither the question
nor the key. Files are written beside and renamed, so that a reader finds a whole one or none, also on
a disk that machines share. Those that were not read for the longest time make room.
"""

from __future__ import annotations

import json
import os
from contextlib import suppress
from dataclasses import asdict
from hashlib import sha256
from pathlib import Path

from parser_service.parsers.model_server.protocol import ModelAnswer, Question

FORMAT = 1  # raised whenever the same question is put in other words
FOLDERS = 256
MOST_ANSWERS = 25_600  # about 100 MB, as a file takes at least 4 kB


class KeptAnswers:
    """The answers in ``folder``; None keeps nothing. The disk is no reason to fail: what cannot be read or
    written is asked again."""

    def __init__(self, folder: Path | None, most: int = MOST_ANSWERS) -> None:
        self._folder = folder
        self._most_in_one = max(1, most // FOLDERS)

    def find(self, question: Question) -> ModelAnswer | None:
        """Return the answer to a question that was asked before."""
        path = self._path(question)
        if path is None:
            return None
        try:
            values = json.loads(path.read_text(encoding="utf-8"))
            answer = ModelAnswer(str(values["text"]), str(values["model"]))
        except (OSError, ValueError, KeyError, TypeError, RecursionError):
            return None
        with suppress(OSError):
            os.utime(path)
        return answer

    def keep(self, question: Question, answer: ModelAnswer) -> None:
        """Keep an answer, and drop the one longest unread where there are too many."""
        path = self._path(question)
        if path is None:
            return
        unfinished = path.with_name(f".{path.name}.{os.getpid()}")
        try:
            path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            unfinished.write_text(json.dumps(asdict(answer)) + "\n", encoding="utf-8")
            unfinished.replace(path)
            files = list(path.parent.iterdir())
            # Hashes fill all folders alike, so that each holds its share of the bound.
            if len(files) > self._most_in_one:
                by_age = sorted(files, key=lambda file: file.stat().st_mtime)
                for file in by_age[: len(files) - self._most_in_one]:
                    file.unlink(missing_ok=True)
        except OSError:
            with suppress(OSError):
                unfinished.unlink(missing_ok=True)

    def _path(self, question: Question) -> Path | None:
        if self._folder is None:
            return None
        name = hash_of(question)
        return self._folder / name[:2] / f"{name}.json"


def hash_of(question: Question) -> str:
    """Return the SHA-256 of the model, the messages, the schema, the seed, the limit and the temperature."""
    text = json.dumps([FORMAT, asdict(question)], sort_keys=True)
    return sha256(text.encode()).hexdigest()
