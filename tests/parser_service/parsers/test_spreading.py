from itertools import pairwise

import pytest

from parser_service.parsers.spreading import spread, visiting_order


def test_few_are_all_kept_in_their_order():
    assert spread("banana", 6) == list("banana")


def test_each_group_has_its_share_and_what_is_left_goes_to_the_large_ones():
    items = [("large", at) for at in range(90)] + [("small", 1), ("small", 2), ("tiny", 1)]
    chosen = spread(items, 10, lambda item: item[0])
    names = [name for name, _ in chosen]
    assert (names.count("large"), names.count("small"), names.count("tiny")) == (7, 2, 1)
    assert chosen == sorted(chosen, key=items.index)


def test_what_is_chosen_of_a_group_spreads_over_it():
    chosen = spread(range(1000), 10)
    gaps = [after - before for before, after in pairwise(chosen)]
    assert max(gaps) < 200 and min(gaps) > 20


@pytest.mark.parametrize("number", [0, 1, 7])
def test_the_visiting_order_has_each_number_once(number):
    assert sorted(visiting_order(number)) == list(range(number))
