"""Log lines: no secret stands in them."""

from __future__ import annotations

import logging

import pytest

from gpsr_site.logs import HideSecrets


def shown(message: str, *args: object) -> str:
    record = logging.LogRecord("django.request", logging.WARNING, "", 0, message, args, None)
    assert HideSecrets().filter(record)
    return record.getMessage()


@pytest.mark.parametrize("end", ["/", "", "/?next=/"])
def test_the_key_of_an_invitation_is_hidden(end):
    assert shown("%s: %s", "Not Found", f"/join/s3cret-key{end}") == f"Not Found: /join/…{end}"


def test_other_lines_stay_as_they_are():
    assert shown("%d of %s", 3, "/w/home/join/") == "3 of /w/home/join/"
