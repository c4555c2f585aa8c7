"""The index that pairs come into and go out of answers as one that is built anew."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from parser_service.labelling.known_pairs import KnownPairs
from parser_service.parsers.interface import Pair
from parser_service.parsers.knn import NearestNeighbour

TEXTS = st.lists(st.sampled_from(["go", "to", "the", "kitchen", "find", "tea"]), min_size=1).map(
    " ".join
)
CHANGES = st.lists(
    st.tuples(st.integers(0, 5), TEXTS, st.sampled_from(["( go )", "( find )", ""])), min_size=1
)


@given(CHANGES, TEXTS, st.integers(1, 4))
def test_after_any_changes_it_answers_as_the_nearest_neighbour_does(changes, text, how_many):
    index, pairs = KnownPairs(), {}
    for key, said, form in changes:
        if form:
            index.put(key, 1, said, form)
            pairs[key] = Pair(said, form)
        else:
            index.drop(key)
            pairs.pop(key, None)
    assert index.versions.keys() == pairs.keys()
    answers = []
    if pairs:
        anew = NearestNeighbour()
        anew.fit(list(pairs.values()))
        answers = [(each.form, each.score) for each in anew.predict([text], how_many)[0]]
    assert index.nearest(text, how_many) == [each for each in answers if each[1] > 0]


def test_places_of_pairs_that_are_gone_are_noticed():
    index = KnownPairs()
    for version in range(150):
        index.put(1, version, "go", "( go )")
    assert index.is_sparse and len(index) == 150
    assert index.nearest("go", 3) == [("( go )", 1.0)]
