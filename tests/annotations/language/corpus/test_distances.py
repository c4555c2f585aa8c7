from __future__ import annotations

from statistics import mean

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import distance, read_triples
from annotations.language.corpus.distances import jaccard, levenshtein, words
from tests.annotations.language.published import SHARED, needs_corpus

TEXTS = st.text("abC ,", max_size=12)


def test_words_are_lower_cased_and_split_on_spaces_and_commas() -> None:
    assert words("Go to the attic ,  find Bo,then go") == {
        "go",
        "to",
        "the",
        "attic",
        "find",
        "bo",
        "then",
    }


def test_distances_of_known_texts() -> None:
    assert levenshtein("kitten", "sitting") == 3
    assert jaccard("Bring me tea", "bring him tea now") == pytest.approx(3 / 5)
    assert jaccard("", " , ") == 0
    assert distance("get tea", "bring tea").edit == 5


@given(TEXTS, TEXTS, TEXTS)
def test_both_distances_are_metrics(a: str, b: str, c: str) -> None:
    for measure in (levenshtein, jaccard):
        assert measure(a, a) == 0
        assert measure(a, b) == measure(b, a) >= 0
        assert measure(a, c) <= measure(a, b) + measure(b, c) + 1e-9


@needs_corpus
def test_the_published_paraphrases_are_as_far_as_published() -> None:
    # 28.02 and 0.59 over all 1,923 records; a copy that holds some of them comes close.
    data = (SHARED / "walker2019" / "paraphrasings.txt").read_bytes()
    distances = [distance(each.paraphrase, each.command) for each in read_triples(data, "").records]
    assert mean(each.edit for each in distances) == pytest.approx(28.02, abs=1)
    assert mean(each.jaccard for each in distances) == pytest.approx(0.59, abs=0.05)
