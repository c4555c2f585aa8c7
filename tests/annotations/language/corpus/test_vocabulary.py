from __future__ import annotations

from itertools import combinations
from statistics import fmean

import pytest

from annotations.language.corpus import expected_vocabulary, vocabulary_growth

TEXTS = ["bring me tea", "tea please", "go to the bath", "bring me the tea", "go go"]


def test_the_vocabulary_grows_text_by_text():
    assert vocabulary_growth([text.split() for text in TEXTS]) == [3, 4, 8, 8, 8]
    assert vocabulary_growth([]) == []


@pytest.mark.parametrize("sample", range(len(TEXTS) + 1))
def test_the_expected_vocabulary_is_the_mean_over_all_samples(sample):
    words = [text.split() for text in TEXTS]
    drawn = [len(set().union(*each)) for each in combinations(map(set, words), sample)]
    assert expected_vocabulary(words, sample) == pytest.approx(fmean(drawn))
