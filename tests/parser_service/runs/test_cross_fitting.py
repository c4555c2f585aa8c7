"""The validation part is scored by parsers that other pairs of it calibrated."""

from __future__ import annotations

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from parser_service.analysis.clustered import folds_of
from parser_service.parsers.interface import Pair
from parser_service.parsers.knn import NearestNeighbour
from parser_service.runs.cross_fitting import FOLDS, calibrated_folds

PAIRS = [Pair(f"say {n}", "( go )") for n in range(12)]
CLUSTERS = [f"cluster {n % 5}" for n in range(12)]


class Calibrated(NearestNeighbour):
    """Remembers what calibrated it."""

    by: tuple[Pair, ...] = tuple(PAIRS)

    def calibrated(self, pairs):
        other = Calibrated(self.config, self.seed)
        other.by = tuple(pairs)
        return other


def test_no_example_is_answered_by_what_its_cluster_calibrated():
    places = []
    for parser, of_fold in calibrated_folds(Calibrated(), CLUSTERS, PAIRS, CLUSTERS):
        places += of_fold
        calibrating = {CLUSTERS[PAIRS.index(pair)] for pair in parser.by}
        assert calibrating
        assert calibrating.isdisjoint(CLUSTERS[at] for at in of_fold)
    assert sorted(places) == list(range(12))


def test_a_parser_that_calibrates_nothing_answers_all_at_once():
    parser = NearestNeighbour()
    assert list(calibrated_folds(parser, CLUSTERS, PAIRS, CLUSTERS)) == [(parser, list(range(12)))]


def test_a_single_cluster_has_no_other_to_calibrate_on():
    parser = Calibrated()
    folds = list(calibrated_folds(parser, ["one"] * 12, PAIRS, ["one"] * 12))
    assert folds == [(parser, list(range(12)))]


def test_nothing_is_asked_of_a_fold_without_examples():
    folds = list(calibrated_folds(Calibrated(), CLUSTERS[:1], PAIRS, CLUSTERS))
    assert [places for _, places in folds] == [[0]]


@given(st.lists(st.text(max_size=4)))
def test_each_fold_has_half_of_the_clusters(clusters):
    folds = folds_of(clusters, FOLDS)
    sizes = Counter(folds.values())
    assert not folds or (set(folds) == set(clusters) and 0 <= sizes[0] - sizes[1] <= 1)
    assert bool(folds) == (len(set(clusters)) > 1)


@given(st.lists(st.text(max_size=4)))
def test_order_and_number_of_the_pairs_do_not_matter(clusters):
    assert folds_of(clusters, FOLDS) == folds_of([*reversed(clusters), *clusters], FOLDS)
