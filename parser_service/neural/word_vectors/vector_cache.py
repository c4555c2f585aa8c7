"""Vectors of a frozen encoder, computed once for each distinct utterance."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from uuid import uuid4

from safetensors.torch import save_file
from torch import Tensor

from parser_service.neural.weights import load_tensors
from parser_service.neural.word_vectors.contextual import ContextualEncoder
from parser_service.parsers.interface import Check, keep_going

Words = tuple[str, ...]
IN_MEMORY = 64 * 2**20  # bytes that stay in memory; more goes to files of this size
RECENT = 256  # utterances that are kept besides those prepared

Report = Callable[[int, int], None]
"""Called with the number of utterances encoded so far, and of all."""


def report_nothing(done: int, of: int) -> None:
    """Ignore the report."""


class VectorCache:
    """Vectors by utterance: in memory or, where there are many and a folder is given, on disk.

    The files are in a folder named by the encoder's hash, so that other weights never find them; the
    tensors in them are named by the hash of their words. Files are mapped into memory. One that
    cannot be read is skipped; all of them may be deleted at any time.
    """

    def __init__(
        self, encoder: ContextualEncoder, folder: Path | None = None, in_memory: int = IN_MEMORY
    ):
        self.encoder = encoder
        self._folder = folder / encoder.identity if folder else None
        self._in_memory = in_memory
        self._kept: dict[Words, Tensor] = {}
        self._recent = lru_cache(maxsize=RECENT)(encoder.vectors)

    def of(self, words: Words) -> Tensor:
        """Return the vectors of one utterance, kept or computed. Shape [words, layers, width]."""
        kept = self._kept.get(words)
        return self._recent(words) if kept is None else kept

    def prepare(
        self,
        utterances: Iterable[Words],
        check: Check = keep_going,
        report: Report = report_nothing,
    ) -> None:
        """Compute or load the vectors of ``utterances``, and keep them as long as this object lives."""
        wanted = sorted(set(utterances) - self._kept.keys())
        if self._are_many(wanted):
            by_key = {_key(words): words for words in wanted}
            if self._folder is not None and self._folder.is_dir():
                for path in sorted(self._folder.glob("*.safetensors")):
                    self._take(path, by_key)
            wanted = [words for words in wanted if words not in self._kept]
        done = 0
        for part in self._parts(wanted):
            computed = {}
            for words in part:
                check()
                computed[words] = self.encoder.vectors(words)
                done += 1
                report(done, len(wanted))
            self._keep(computed, self._are_many(wanted))

    def _are_many(self, utterances: Sequence[Words]) -> bool:
        return self._folder is not None and sum(map(self._bytes, utterances)) > self._in_memory

    def _bytes(self, words: Words) -> int:
        return 4 * len(words) * self.encoder.layers * self.encoder.width

    def _parts(self, utterances: Sequence[Words]) -> Iterator[list[Words]]:
        """Yield the utterances in parts of about ``in_memory`` bytes of vectors."""
        part, size = [], 0
        for words in utterances:
            part.append(words)
            size += self._bytes(words)
            if size >= self._in_memory:
                yield part
                part, size = [], 0
        if part:
            yield part

    def _keep(self, computed: dict[Words, Tensor], on_disk: bool) -> None:
        if not on_disk or self._folder is None:
            self._kept.update(computed)
            return
        self._folder.mkdir(parents=True, exist_ok=True)
        path = self._folder / f"{uuid4().hex}.safetensors"
        unfinished = path.with_suffix(".part")
        save_file({_key(words): value for words, value in computed.items()}, unfinished)
        unfinished.replace(path)
        self._take(path, {_key(words): words for words in computed})

    def _take(self, path: Path, by_key: dict[str, Words]) -> None:
        """Keep the vectors that a file has of the utterances in ``by_key``."""
        try:
            tensors = load_tensors(path)
        except ValueError:
            return
        for key in tensors.keys() & by_key.keys():
            words, value = by_key[key], tensors[key]
            if value.shape == (len(words), self.encoder.layers, self.encoder.width):
                self._kept[words] = value


def _key(words: Words) -> str:
    return sha256(" ".join(words).encode()).hexdigest()
