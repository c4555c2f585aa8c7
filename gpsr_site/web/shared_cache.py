"""A cache in the database that all processes of the site share."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from django.core.cache.backends.db import DatabaseCache
from django.db import DatabaseError

from annotations.background.failures import is_disk_full


class SharedCache(DatabaseCache):
    """Django's cache in the database, which can also be read while the disk is full.

    Django deletes what has expired when it reads, and stores what a page has worked out: neither may keep
    a page from being read. ``add`` stores nothing then and returns False, so that nothing goes uncounted.
    """

    def get_many(self, keys: Iterable[str], version: int | None = None) -> dict[str, Any]:
        """Return what is kept under ``keys``; nothing where what has expired cannot be deleted."""
        try:
            return super().get_many(keys, version)
        except DatabaseError as error:
            if not is_disk_full(error):
                raise
            return {}

    def get_or_set(
        self, key: str, default: Any, timeout: Any = ..., version: int | None = None
    ) -> Any:
        """Return what is kept under ``key``, else ``default``, which is kept where there is space."""
        value = self.get(key, version=version)
        if value is not None:
            return value
        value = default() if callable(default) else default
        options = {} if timeout is ... else {"timeout": timeout}
        try:
            self.add(key, value, version=version, **options)
        except DatabaseError as error:
            if not is_disk_full(error):
                raise
        return value
