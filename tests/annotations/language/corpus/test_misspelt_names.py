import pytest

from annotations.language.corpus import MisspeltNames

NAMES = ("sugar", "apple", "rubiks cube", "kitchen table")


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("find the suger please", "sugar"),
        ("bring me the rubix cube", "rubiks cube"),
        ("put it on the kitchentable", "kitchen table"),
        ("find the sugar", None),  # English words are no misspelt ones
        ("the suger and the aple", None),  # which?
        ("open the door", None),
        ("", None),
        ("flurb " * 500, None),
    ],
)
def test_a_misspelt_name_is_found_where_it_is_sure(said, meant):
    assert MisspeltNames().find(said, NAMES) == meant
