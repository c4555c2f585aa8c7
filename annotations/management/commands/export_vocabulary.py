"""``export_vocabulary W --as txt|jsonl|vosk``: the names and words of a world for a speech recogniser."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.vocabulary_export import (
    VocabularyFormat,
    VocabularyPart,
    vocabulary_file,
    vocabulary_of,
    vocabulary_pieces,
)
from annotations.management.base import ReportingCommand, find_world


class Command(ReportingCommand):
    help = (
        "Writes the names of a world, their aliases and plurals, and the fixed words of its grammar: "
        "hot words for a speech recogniser."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("world")
        parser.add_argument(
            "--as", dest="as_", choices=VocabularyFormat.values, default=VocabularyFormat.TXT
        )
        parser.add_argument("--only", choices=VocabularyPart.values, help="names or words alone")
        parser.add_argument(
            "--output", type=Path, help="the file to write; W-vocabulary.txt by default"
        )

    def report(
        self, *, world: str, as_: str, only: str | None, output: Path | None, **options: Any
    ) -> Mapping[str, Any]:
        exported = find_world(world)
        phrases = vocabulary_of(exported, only)
        path = output or Path(vocabulary_file(exported, as_))
        with path.open("wb") as file:
            file.writelines(vocabulary_pieces(phrases, as_))
        kinds = Counter(str(each.kind) for each in phrases)
        return {"world": world, "output": str(path), "phrases": len(phrases), "kinds": kinds}
