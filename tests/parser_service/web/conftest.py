"""No broker."""

from __future__ import annotations

import pytest


@pytest.fixture
def no_messages(monkeypatch):
    """Starting a run sends a message to a broker, which these tests need not have."""
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)
