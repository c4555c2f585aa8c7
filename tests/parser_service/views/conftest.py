"""A furnished world and its annotator, logged in."""

from __future__ import annotations

import pytest
from django.core.cache import cache
from django.test import Client

from tests.furnishing import House, furnish


@pytest.fixture(autouse=True)
def no_earlier_runs():
    """The runs that an admin starts within an hour are counted, whichever test that was in."""
    cache.clear()


@pytest.fixture
def no_messages(monkeypatch):
    """Starting a run sends a message to a broker, which these tests need not have."""
    monkeypatch.setattr("parser_service.waking.send_wake_up", lambda queue: None)


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
