"""The table of docs/reference/rest.md names every route."""

from __future__ import annotations

import re
from pathlib import Path

from tests.gpsr_site.routes.listing import ALL_ROUTES

TEXT = (Path(__file__).resolve().parent.parent / "docs" / "reference" / "rest.md").read_text(
    encoding="utf-8"
)


def test_the_table_names_every_route():
    table = TEXT[TEXT.index("## Routes") :]
    paths = [path for name, path in ALL_ROUTES.items() if name.startswith("api:")]
    for path in paths:
        below = path.removeprefix("api/v1/worlds/<slug:world>/").removeprefix("api/v1/")
        nouns = re.sub(r"<[^>]+>", "", below).strip("/").split("/")
        for noun in filter(None, nouns):
            assert f"{noun}/" in table, path
