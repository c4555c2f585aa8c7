"""What is read of very many rows is kept for a while; what is read of few is always that of now."""

from __future__ import annotations

from collections import OrderedDict

import pytest

from annotations.rows import kept

MANY = kept.MOST_READ + 1


@pytest.fixture(autouse=True)
def _nothing_kept(monkeypatch):
    """Nothing is kept, and each look at the clock moves it on by a second."""
    seconds = iter(range(100_000))
    monkeypatch.setattr(kept, "_kept", OrderedDict())
    monkeypatch.setattr(kept, "monotonic", lambda: next(seconds))


def values_of(rows, times):
    values = iter(range(times))
    return [kept.kept("figure", lambda: next(values), lambda _: rows) for _ in range(times)]


def test_a_figure_of_few_rows_is_computed_each_time():
    assert values_of(kept.MOST_READ, 3) == [0, 1, 2]


def test_one_of_many_rows_is_kept_for_a_multiple_of_its_time():
    values = values_of(MANY, kept.SHARE + 10)
    assert values[:10] == [0] * 10
    assert values[-1] == 1


def test_figures_of_different_keys_are_kept_apart_and_the_oldest_are_dropped():
    for number in range(kept.MOST_KEPT + 1):
        assert kept.kept(number, lambda number=number: number, lambda _: MANY) == number
    assert len(kept._kept) == kept.MOST_KEPT
    assert 0 not in kept._kept
