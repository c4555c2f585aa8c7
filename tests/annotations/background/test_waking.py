"""A broker that does not take a message costs seconds: a timer finds the work."""

from __future__ import annotations

import os
from urllib.parse import urlsplit

import pytest

from annotations.background.waking import send_wake_up
from gpsr_site.celery import app


@pytest.fixture
def broker(monkeypatch):
    """Points Celery to another address, as an operator does."""

    def point(address: str) -> None:
        monkeypatch.setattr(app.conf, "broker_url", address)
        monkeypatch.setattr(app.conf, "broker_write_url", address)
        app.conf.broker_transport = "amqp"
        monkeypatch.setattr(app, "_pool", None)
        app.amqp._producer_pool = None

    transport = app.conf.get("broker_transport")
    yield point
    app.conf.broker_transport = transport
    app.amqp._producer_pool = None


@pytest.mark.parametrize("place", ["gone", "nobody:wrong@127.0.0.1:5672//"])
def test_a_virtual_host_or_account_that_is_gone_is_a_line_in_the_log(place, broker, caplog):
    address = os.environ.get("TEST_BROKER_URL", "")
    if not address.startswith("amqp"):
        pytest.skip("needs RabbitMQ (TEST_BROKER_URL)")
    server = f"amqp://{urlsplit(address).netloc}"
    broker(f"{server}/{place}" if place == "gone" else f"amqp://{place}")
    send_wake_up("cpu")
    (record,) = caplog.records
    assert record.levelname == "WARNING" and "cpu" in record.getMessage()


def test_a_broker_that_is_away_is_a_line_in_the_log(broker, caplog):
    broker("amqp://guest:guest@127.0.0.1:9//")
    send_wake_up("cpu")
    (record,) = caplog.records
    assert record.levelname == "WARNING" and "cpu" in record.getMessage()
