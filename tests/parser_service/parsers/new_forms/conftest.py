"""A small corpus of forms that differ from one another in one thing."""

import pytest

from parser_service.parsers.interface import Pair


def find(*descriptions: str) -> str:
    return f"( find ( lambda $1 e {' '.join(f'( {each} )' for each in descriptions)} ) )"


def bring(*descriptions: str) -> str:
    return find(*descriptions).replace("( find", "( bring", 1)


OBJECT, ROOM, PLACE = 'is_a $1 " <object> "', 'at $1 " <room> "', 'at $1 " <location> "'
WAVING, NAMED = 'is $1 " <gesture> "', 'name $1 " <name> "'


@pytest.fixture
def pairs():
    return [
        Pair("bring me the <object> from the <room> now", bring(OBJECT, ROOM)),
        Pair("bring me the <object> at the <location> now", bring(OBJECT, PLACE)),
        Pair("please find the <object> from the <room>", find(OBJECT, ROOM)),
    ]
