"""Merge two changes of the same row, field by field. No database: texts in, texts out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MergedField:
    """One field before (None where that is not known) and after the edits of two people.

    ``merged`` is the change of whoever changed it; where both did, differently, it is mine and
    ``is_clash``.
    """

    name: str
    base: str | None
    theirs: str
    mine: str

    @property
    def is_clash(self) -> bool:
        return self.theirs != self.mine and self.base not in (self.theirs, self.mine)

    @property
    def merged(self) -> str:
        return self.theirs if self.mine == self.base else self.mine

    @property
    def is_same(self) -> bool:
        """Whether nobody has to look at it."""
        return self.theirs == self.mine


def merge(
    base: Mapping[str, str] | None, theirs: Mapping[str, str], mine: Mapping[str, str]
) -> Iterator[MergedField]:
    """Merge the fields of ``mine``, in their order; ``base`` is None where it is not known."""
    for name, text in mine.items():
        yield MergedField(name, base[name] if base else None, theirs[name], text)
