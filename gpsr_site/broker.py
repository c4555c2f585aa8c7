"""Celery's filesystem broker, with messages that appear whole.

Kombu writes a message into a file that readers already see: one that is faster than the writer
finds it empty, and its worker stops. And it takes a message by moving it to the system's temporary
folder, which copies it where that is another file system. Here a message is renamed within its
folder, once when it is complete and once by the one worker that takes it.
"""

from __future__ import annotations

import os
import time
import uuid
from pathlib import Path
from queue import Empty
from typing import Any

from kombu.exceptions import ChannelError
from kombu.transport import filesystem
from kombu.utils.json import dumps, loads


class Channel(filesystem.Channel):
    """A folder of messages, oldest first by name."""

    def _get(self, queue: str, timeout: float | None = None) -> Any:
        """Take the oldest message of ``queue``: whoever renames it first has it. Raises Empty."""
        for path in sorted(Path(self.data_folder_in).glob(f"*.{queue}.msg")):
            taken = path.with_suffix(".reading")
            try:
                os.replace(path, taken)
            except FileNotFoundError:
                continue
            text = taken.read_text(encoding="utf-8")
            taken.unlink()
            return loads(text)  # type: ignore[no-untyped-call]  # of kombu
        raise Empty

    def _put(self, queue: str, payload: Any, **kwargs: Any) -> None:  # type: ignore[override]  # kombu has two names for it
        """Put ``payload`` onto ``queue``. Raises ChannelError where the folder cannot be written."""
        folder = Path(self.data_folder_out)
        name = f"{time.time_ns():020}_{uuid.uuid4()}"
        unfinished = folder / f"{name}.writing"
        try:
            text = dumps(payload)  # type: ignore[no-untyped-call]  # of kombu
            unfinished.write_text(text, encoding="utf-8")
            os.replace(unfinished, folder / f"{name}.{queue}.msg")
        except OSError as error:
            raise ChannelError(f"Cannot write a message into {folder}: {error}") from error


class Transport(filesystem.Transport):
    """The filesystem transport, named by ``CELERY_BROKER_TRANSPORT``."""

    Channel = Channel
