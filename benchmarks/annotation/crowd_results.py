"""What a file of crowd results costs: its check and its import, in processor time, and how long the import writes.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.annotation.crowd_results [--rows 10000] [--answers 12]
        [--database postgres://postgres@127.0.0.1:5432/results]

Every row answers prompts of a campaign of the 2018 world: first one of them, as the published example does, then
``--answers``, with two free commands. Answers are the published paraphrases (``paraphrasings.txt``), in random
order, with a word of their own. The bound is 30 s of processor time for check and import of the rows with one answer.
"""

from __future__ import annotations

import argparse
import csv
import io
import os
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random
from typing import Any

from benchmarks.fresh_site import DATA, WORLD, Site

MOST_SECONDS = 30.0
FREE_COMMANDS = 2


def table(
    prompts: Sequence[tuple[str, str, str]], texts: Sequence[str], rows: int, size: int
) -> bytes:
    """Return the bytes of a table: ``rows`` assignments, each by somebody else, with ``size`` answers."""
    random = Random(0)
    numbers = range(1, size + 1)
    kinds = ("command", "parse", "parse_ground")
    written = io.StringIO()
    writer = csv.writer(written)
    writer.writerow(
        [
            *("HITId", "WorkerId", "AssignmentStatus", "WorkTimeInSeconds"),
            *(f"Input.{kind}{number}" for number in numbers for kind in kinds),
            *(f"Answer.utterance{number}" for number in numbers),
            *(f"Answer.custom{number + 1}" for number in range(FREE_COMMANDS)),
            "Answer.comment",
        ]
    )
    for row in range(rows):
        chosen = random.sample(prompts, size)
        answers = [f"{random.choice(texts)} {row}" for _ in range(size + FREE_COMMANDS)]
        inputs = [cell for prompt in chosen for cell in prompt]
        writer.writerow([f"H{row}", f"W{row}", "Approved", "600", *inputs, *answers, ""])
    return written.getvalue().encode()


class Steps:
    """Says how long a verb held the database."""

    seconds = 0.0

    def report(self, fraction: float, message: str) -> None:
        pass

    def check(self) -> None:
        pass

    def writing(self) -> Any:
        from contextlib import contextmanager

        from django.db import transaction

        @contextmanager
        def timed() -> Iterator[None]:
            began = time.perf_counter()
            with transaction.atomic():
                yield
            self.seconds = time.perf_counter() - began

        return timed()

    def conclude(self, report: Any) -> None:
        pass


def measure(campaign: Any, data: bytes, by: Any) -> float:
    """Check and import ``data``; print and return the seconds of processor time of both."""
    from annotations.background.job_files import KeptUpload
    from annotations.campaigns.crowd_jobs import read_results
    from annotations.campaigns.crowd_results import plan_results, store_results

    began = time.process_time()
    read, _ = read_results(KeptUpload(io.BytesIO(data), "results.csv"))
    reading = time.process_time() - began
    plan_results(campaign, read, "results.csv")
    checked = time.process_time() - began
    steps = Steps()
    again, _ = read_results(KeptUpload(io.BytesIO(data), "results.csv"))
    plan = plan_results(campaign, again, "results.csv", steps)
    report = store_results(plan, again, by, steps)
    imported = time.process_time() - began - checked
    counts = report["counts"]
    print(
        f"{len(data) / 1e6:.1f} MB, {counts['assignments']:,} rows, {counts['rewrites']:,} rewrites: "
        f"check {checked:.1f} s ({reading:.1f} s of it reading), import {imported:.1f} s, of which "
        f"{steps.seconds:.1f} s on the clock in one transaction; flags {report['flags']}"
    )
    return checked + imported


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rows", type=int, default=10_000)
    parser.add_argument("--answers", type=int, default=12)
    parser.add_argument("--database", default="")
    args = parser.parse_args()
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    texts = (DATA / "walker2019" / "paraphrasings.txt").read_text().splitlines()[::3]
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var", args.database)
        site.import_world()
        site.run("generate_pairs", WORLD)
        site.enter()
        from annotations.campaigns.launching import PromptChoice, launch
        from annotations.models import Campaign, User, World

        world, by = World.objects.get(name=WORLD), User.objects.create_superuser("root")
        spent = []
        for size in (1, args.answers):
            unsaved = Campaign(world=world, name=f"of {size}")
            campaign = launch(unsaved, PromptChoice(target_per_form=1_000), by)
            prompts = list(campaign.prompts.values_list("shown", "logical_form", "grounded_form"))
            spent.append(measure(campaign, table(prompts, texts, args.rows, size), by))
    if spent[0] > MOST_SECONDS:
        sys.exit(f"over the bound of {MOST_SECONDS:.0f} s")


if __name__ == "__main__":
    main()
