"""A furnished world, and a clean slate for the counters of attempts."""

from __future__ import annotations

import pytest
from django.core.cache import cache

from tests.furnishing import House, furnish


@pytest.fixture(autouse=True)
def no_earlier_attempts():
    cache.clear()


@pytest.fixture
def house(world) -> House:
    return furnish(world)


@pytest.fixture
def other_house(other_world) -> House:
    return furnish(other_world)
