"""The tokens that can continue one of a list of forms."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


class Trie:
    """Sequences of tokens by their beginnings. Each ends with the token that ends a form."""

    def __init__(self, sequences: Iterable[Sequence[int]]):
        self._root: dict[int, dict] = {}  # type: ignore[type-arg]
        for sequence in sequences:
            node = self._root
            for token in sequence:
                node = node.setdefault(token, {})

    def continuations(self, tokens: Sequence[int]) -> list[int]:
        """Return what follows ``tokens`` in a sequence; nothing where no sequence begins so."""
        node = self._root
        for token in tokens:
            node = node.get(token, {})
        return list(node)
