"""Every address of a world answers where the world has nothing yet."""

from __future__ import annotations

from django.test import Client
from django.urls import NoReverseMatch, reverse

from tests.gpsr_site.routes.listing import ALL_ROUTES
from tests.gpsr_site.routes.rules import undone


def test_every_address_of_a_world_without_rows_answers(world, client_as):
    client: Client = client_as("superuser")
    client.raise_request_exception = False
    failed = []
    for name in ALL_ROUTES:
        try:
            url = reverse(name, kwargs={"world": world.name})
        except NoReverseMatch:
            continue
        for method in ("get", "post"):
            with undone():
                status = client.generic(method, url, b"{}", "application/json").status_code
            if status >= 500:
                failed.append(f"{method} {url}: {status}")
    assert not failed, failed
