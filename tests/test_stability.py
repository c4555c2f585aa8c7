"""What version 1 promises: what other programs build on only grows (docs/reference/stability.md)."""

from __future__ import annotations

import pytest

from tests.clients.conftest import CLIENT
from tests.stable_surface import Surface, read_stored, surface


def gone(stored: Surface, now: Surface) -> list[str]:
    """What was there and is not, and what a body of the API needs that it did not need."""
    broken = []
    for kind, names in stored.items():
        for name, words in names.items():
            there = now[kind].get(name)
            if there is None:
                broken.append(f"{kind}: {name}")
                continue
            broken += [
                f"{kind}: {name} {each}"
                for each in words
                if each not in there and not each.startswith("!")
            ]
            needed = {each for each in there if each.startswith("!")}
            broken += [f"{kind}: {name} {each}" for each in needed.difference(words)]
    return broken


def test_nothing_that_programs_build_on_is_gone():
    """What was added stands in the file once somebody writes it anew: python -m tests.stable_surface."""
    assert CLIENT.is_dir()
    stored, now = read_stored(), surface()
    assert gone(stored, now) == []
    fields = stored["export"]["fields"]
    assert now["export"]["fields"][: len(fields)] == fields


@pytest.mark.parametrize(
    "now",
    [
        {"rest": {}},
        {"rest": {"GET /a/": [">id", "!name"]}},
        {"rest": {"GET /a/": ["?q", "!name"]}},
        {"rest": {"GET /a/": ["?q", ">id", "!name", "!day"]}},
    ],
)
def test_what_is_gone_or_newly_needed_is_seen(now):
    stored = {"rest": {"GET /a/": ["?q", ">id", "!name"]}}
    assert gone(stored, now)
    assert not gone(stored, {"rest": {"GET /a/": ["?q", "?new", ">id"], "GET /b/": []}})
