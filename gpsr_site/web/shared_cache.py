"""A cache in the database that all processes of the site share."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from django.core.cache.backends.db import DatabaseCache
from django.db import DatabaseError, IntegrityError, connections, router, transaction

from annotations.background.failures import disk_trouble


class SharedCache(DatabaseCache):
    """Django's cache in the database, which can also be read while the disk cannot be written.

    Django deletes what has expired when it reads, and stores what a page has worked out: neither may keep
    a page from being read. And its ``add`` answers False both where somebody else has the key and where
    nothing could be stored. Here False means the first alone.
    """

    def add(self, *args: Any, **kwargs: Any) -> bool:
        """Return whether the key was free, and is now taken. Raises what keeps the database from storing it."""
        using = router.db_for_write(self.cache_model_class)
        errors: list[DatabaseError] = []

        def watch(execute: Callable[..., Any], *call: Any) -> Any:
            try:
                return execute(*call)
            except DatabaseError as error:
                errors.append(error)
                raise

        # The transaction ends here, not in Django's method, which would drop the error of its end too.
        with transaction.atomic(using), connections[using].execute_wrapper(watch):
            is_stored = super().add(*args, **kwargs)
            if not is_stored and errors and not isinstance(errors[-1], IntegrityError):
                raise errors[-1]
        return is_stored

    def get_many(self, keys: Iterable[str], version: int | None = None) -> dict[str, Any]:
        """Return what is kept under ``keys``; nothing where what has expired cannot be deleted."""
        try:
            return super().get_many(keys, version)
        except DatabaseError as error:
            if not disk_trouble(error):
                raise
            return {}

    def get_or_set(
        self, key: str, default: Any, timeout: Any = ..., version: int | None = None
    ) -> Any:
        """Return what is kept under ``key``, else ``default``, which is kept where that can be written."""
        value = self.get(key, version=version)
        if value is not None:
            return value
        value = default() if callable(default) else default
        options = {} if timeout is ... else {"timeout": timeout}
        try:
            self.add(key, value, version=version, **options)
        except DatabaseError as error:
            if not disk_trouble(error):
                raise
        return value
