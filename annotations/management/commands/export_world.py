"""``export_world W --output F``: everything that a world holds, as one archive."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.world_export import archive_name, world_archive
from annotations.management.base import ReportingCommand, find_world


class Command(ReportingCommand):
    help = (
        "Writes a world as one zip archive: the files of its generator, its commands, paraphrases "
        "and splits. import_world makes the same world from it."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument("--output", type=Path, help="the file to write; W-world.zip by default")

    def report(self, *, world: str, output: Path | None, **options: Any) -> Mapping[str, Any]:
        exported = find_world(world)
        path = output or Path(archive_name(exported))
        with path.open("wb") as file:
            file.writelines(world_archive(exported))
        return {"world": world, "output": str(path), "bytes": path.stat().st_size}
