"""Whose word is taken for where a request comes from."""

from __future__ import annotations

from ipaddress import ip_network

import pytest
from django.http import HttpResponse
from django.test import RequestFactory

from gpsr_site.web.proxies import ClientAddress, client_address


@pytest.fixture
def trusting(settings):
    settings.TRUSTED_PROXIES = [ip_network("10.0.0.0/8"), ip_network("::1")]


def seen_by_the_view(**headers):
    requests = []

    def view(request):
        requests.append(request)
        return HttpResponse()

    ClientAddress(view)(RequestFactory().get("/", **headers))
    return requests[0].META


@pytest.mark.parametrize(
    ("forwarded", "address"),
    [
        ("", "10.0.0.1"),
        ("192.0.2.7", "192.0.2.7"),
        ("192.0.2.7, 10.0.0.2", "192.0.2.7"),
        ("203.0.113.1, 192.0.2.7", "192.0.2.7"),  # the first is the client's own claim
        ("192.0.2.7, rubbish", "10.0.0.1"),
        ("2001:db8::1", "2001:db8::1"),
        ("10.0.0.3, 10.0.0.2", "10.0.0.3"),
    ],
)
def test_the_nearest_address_that_is_no_proxy_counts(forwarded, address, trusting):
    assert client_address("10.0.0.1", forwarded) == address


def test_a_trusted_proxy_is_believed(trusting):
    meta = seen_by_the_view(
        REMOTE_ADDR="10.1.2.3", HTTP_X_FORWARDED_FOR="192.0.2.7", HTTP_X_FORWARDED_PROTO="https"
    )
    assert meta["REMOTE_ADDR"] == "192.0.2.7"
    assert meta["HTTP_X_FORWARDED_PROTO"] == "https"


def test_nobody_else_is(trusting):
    meta = seen_by_the_view(
        REMOTE_ADDR="192.0.2.1", HTTP_X_FORWARDED_FOR="192.0.2.7", HTTP_X_FORWARDED_PROTO="https"
    )
    assert meta["REMOTE_ADDR"] == "192.0.2.1"
    assert "HTTP_X_FORWARDED_PROTO" not in meta and "HTTP_X_FORWARDED_FOR" not in meta
