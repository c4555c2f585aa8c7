"""Pairs of utterance and form that come and go, and those of them that share the most words with a text."""

from __future__ import annotations

from array import array
from collections import defaultdict

import numpy as np

from parser_service.parsers.words import words

GONE = 0  # the number of the form of a pair that was replaced or dropped


class KnownPairs:
    """An inverted index of the words of some pairs, each under a key.

    Putting or dropping a pair costs what its own words cost, whatever the number of the others. The place of one that
    is gone stays taken: whoever finds the index ``is_sparse`` makes a new one. Not for several threads at once.
    """

    def __init__(self) -> None:
        self.versions: dict[int, int] = {}  # key → the version that was put
        self._places: dict[int, int] = {}
        self._postings: dict[str, array[int]] = defaultdict(lambda: array("q"))
        self._sizes: array[int] = array("q")  # [places], words of the pair
        self._form_of: array[int] = array("q")  # [places]
        self._forms = [""]
        self._numbers = {"": GONE}

    def __len__(self) -> int:
        """The places that are taken: what memory grows with."""
        return len(self._sizes)

    @property
    def is_sparse(self) -> bool:
        return len(self) > 100 + 2 * len(self._places)

    def put(self, key: int, version: int, text: str, form: str) -> None:
        """Keep this pair, in place of the one under ``key`` if there is one."""
        self.drop(key)
        number = self._numbers.setdefault(form, len(self._forms))
        if number == len(self._forms):
            self._forms.append(form)
        vocabulary = set(words(text))
        for word in vocabulary:
            self._postings[word].append(len(self))
        self._places[key], self.versions[key] = len(self), version
        self._sizes.append(len(vocabulary))
        self._form_of.append(number)

    def drop(self, key: int) -> None:
        """Forget the pair under ``key``, if there is one."""
        if key in self._places:
            self._form_of[self._places.pop(key)] = GONE
            del self.versions[key]

    def nearest(self, text: str, how_many: int) -> list[tuple[str, float]]:
        """Return the forms of the nearest pairs, each once, with the share of common words (1 − the Jaccard distance).

        Of equally near forms the one that more of the nearest pairs have comes first, then the first in alphabetical
        order. A form that shares no word is left out.
        """
        vocabulary = set(words(text))
        found = [np.array(self._postings[word]) for word in vocabulary if word in self._postings]
        if not found:
            return []
        shared = np.bincount(np.concatenate(found), minlength=len(self))  # [places]
        overlap = shared / np.maximum(np.array(self._sizes) + len(vocabulary) - shared, 1)
        form_of = np.array(self._form_of)  # [places]
        best = np.zeros(len(self._forms))  # [forms]
        np.maximum.at(best, form_of, overlap)
        best[GONE] = 0
        votes = np.bincount(form_of[overlap == best[form_of]], minlength=len(best))  # [forms]
        least = np.partition(best, -how_many)[-how_many] if how_many < len(best) else 0.0
        chosen = np.flatnonzero((best > 0) & (best >= least))
        ranked = sorted(chosen, key=lambda each: (-best[each], -votes[each], self._forms[each]))
        return [(self._forms[each], float(best[each])) for each in ranked[:how_many]]
