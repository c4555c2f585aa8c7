"""Mean and spread over seeds."""

from __future__ import annotations

import pytest

from parser_service.analysis.scores import over_seeds


def test_the_spread_is_the_sample_standard_deviation():
    summary = over_seeds([0.80, 0.82, 0.87])
    assert (round(summary.mean, 4), summary.n_seeds) == (0.83, 3)
    # Squares of -0.03, -0.01 and 0.04 over n - 1 = 2.
    assert summary.spread == pytest.approx((0.0026 / 2) ** 0.5)


def test_one_seed_has_no_spread():
    assert (over_seeds([0.5]).mean, over_seeds([0.5]).spread) == (0.5, None)


def test_no_seed_is_refused():
    with pytest.raises(ValueError) as refused:
        over_seeds([])
    assert type(refused.value) is ValueError  # not that of the library
