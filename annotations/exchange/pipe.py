"""A file whose content is sent on while it is written."""

from __future__ import annotations

import io
from typing import Any


class Pipe(io.RawIOBase):
    """A file that gives away what was written to it, so that nothing is kept."""

    def __init__(self) -> None:
        super().__init__()
        self._pieces: list[bytes] = []

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        self._pieces.append(bytes(data))
        return len(data)

    def take(self) -> bytes:
        """Return what was written since the last call."""
        data, self._pieces = b"".join(self._pieces), []
        return data
