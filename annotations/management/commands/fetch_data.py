"""``fetch_data FOLDER``: the published corpus and generators."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from django.core.management.base import CommandParser

from annotations.exchange.published_data import fetch, published_data
from annotations.management.base import RefusedReport, ReportingCommand


class Command(ReportingCommand):
    help = (
        "Fetches the published corpus and the generators of 2018 and 2019 into a folder, and checks them. What is "
        "there already is checked alone, so it goes on where it was stopped, and takes files that you put there."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("folder", type=Path, help="which GPSR_SHARED_DATA can name")

    def report(self, *, folder: Path, **options: Any) -> Mapping[str, Any]:
        report: dict[str, Any] = {"folder": str(folder), "fetched": 0, "there": 0}
        sentences: list[str] = []
        for data_set in published_data():
            faults: dict[str, list[str]] = {}
            place = folder / data_set.folder
            for path, wrong, was_there in fetch(data_set, folder):
                if wrong:
                    faults.setdefault(wrong, []).append(str(path.relative_to(place)))
                else:
                    report["there" if was_there else "fetched"] += 1
            sentences += [
                f"{place}: {', '.join(names)} {wrong}." for wrong, names in faults.items()
            ]
            if faults:
                sentences.append(
                    f"By hand: open {data_set.by_hand} where there is a network, put the files into {place} under "
                    "these names, and run this command again: it checks them."
                )
        if sentences:
            raise RefusedReport(report, sentences)
        return report
