"""The archive of a world of version 1.0, with every table, is read by every version 1."""

from __future__ import annotations

import io
import json
from pathlib import Path

from annotations.exchange.world_import import import_world
from annotations.models import World
from tests.annotations.exchange.packing import members_of, pack

ARCHIVE = Path(__file__).with_name("world-1.0.zip")


def test_a_world_of_version_1_0_arrives_whole(admin):
    """All of its rows, with all of their columns; newer tables are empty, and newer columns have their defaults."""
    before = members_of(io.BytesIO(ARCHIVE.read_bytes()))
    import_world("again", io.BytesIO(ARCHIVE.read_bytes()))
    after = members_of(pack(World.objects.get(name="again")))
    rows = [name for name in before if name.startswith("rows/")]
    assert len(rows) > 25 and json.loads(before["world.json"])["version"] == 1
    for name in rows:
        old, new = (list(map(json.loads, each[name].splitlines())) for each in (before, after))
        assert len(old) == len(new) > 0, name
        for was, is_ in zip(old, new, strict=True):
            changed = {key for key in was if is_.get(key) != was[key]}
            assert not changed, (name, changed)
