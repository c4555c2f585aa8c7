"""A furnished world and its annotator, logged in."""

from __future__ import annotations

import pytest
from django.test import Client

from tests.furnishing import House, furnish


@pytest.fixture
def house(world) -> House:
    return furnish(world)


@pytest.fixture
def anna(annotator) -> Client:
    client = Client()
    client.force_login(annotator)
    return client


@pytest.fixture
def adam(admin) -> Client:
    client = Client()
    client.force_login(admin)
    return client
