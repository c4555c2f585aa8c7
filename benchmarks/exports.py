"""How fast a split of a million examples is given out in each format, and how much memory that takes.

    .venv/bin/python -m benchmarks.exports [--examples 1000000] [--only parquet] [--keep FOLDER]
        [--only round-trip] [--database postgres://postgres@127.0.0.1:5432/exports]

Makes a split in a fresh installation whose examples are those of the published 2018 generator with a number of
their own, and requests each format through Django's test client, in a process of its own: rows a second of wall
time and of processor time, size of the file, and peak memory of the process with Django in it. ``txt`` is the
largest pair file. ``round-trip`` writes all pair files with ``export_split``, imports them into another world with
``import_pairs``, writes them again, and compares every byte. With ``--keep`` a folder that holds an installation
already is measured as it is.
"""

from __future__ import annotations

import argparse
import filecmp
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.fresh_site import ROOT, WORLD, Site

FORMATS = ("txt", "jsonl", "csv", "parquet", "zip")
ROUND_TRIP = "round-trip"
LEAST_RATE, MOST_MEGABYTES = 20_000, 300  # rows a second; of memory
AT_ONCE = 10_000


def fill(site: Site, count: int) -> None:
    """Make a split of ``count`` examples, nine tenths of them for training."""
    site.import_world()
    site.run("generate_pairs", WORLD)
    site.enter()
    from annotations.models import Command, Example, Split, User, World

    world = World.objects.get(name=WORLD)
    User.objects.create_superuser("root")
    names = ("anonymized_text", "task_category", "logical_form__text")
    known = list(Command.objects.filter(world=world).values_list(*names))
    split = Split.objects.create(
        world=world, name="million", criterion="command", seed=0, content_hash="0" * 64
    )
    made: list[Example] = []
    for number in range(count):
        text, category, form = known[number % len(known)]
        values = {"task_category": category, "logical_form": form, "source_command": text}
        part = "test" if number % 10 == 0 else "train"
        example = Example(
            split=split, position=number, part=part, utterance=f"{text} w{number}", **values
        )
        example.source = "generated"
        made.append(example)
        if len(made) == AT_ONCE or number == count - 1:
            Example.objects.bulk_create(made)
            made = []


def measure(site: Site, format_: str) -> dict[str, float]:
    """Request one format and return rows, seconds, bytes and the peak of memory, in megabytes."""
    site.enter()
    from django.conf import settings
    from django.http import StreamingHttpResponse
    from django.test import Client

    from annotations.models import Split, User

    settings.ALLOWED_HOSTS = ["testserver"]
    split = Split.objects.get(name="million")
    client = Client()
    client.force_login(User.objects.get(username="root"))
    chosen = "&part=train&source=generated" if format_ == "txt" else ""
    path = f"/api/v1/worlds/{WORLD}/splits/{split.pk}"
    rows = client.get(f"{path}/manifest/?{chosen}").json()["examples"]
    began, busy = time.perf_counter(), time.process_time()
    size = 0
    answer = client.get(f"{path}/export/?as={format_}{chosen}")
    assert isinstance(answer, StreamingHttpResponse)
    for piece in answer.streaming_content:
        size += len(piece)
    seconds, busy = time.perf_counter() - began, time.process_time() - busy
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {
        "rows": rows,
        "seconds": seconds,
        "processor": busy,
        "bytes": size,
        "megabytes": peak,
    }


def report(format_: str, figures: dict[str, float]) -> bool:
    """Print one line; return whether both bounds hold."""
    rate = figures["rows"] / figures["seconds"]
    is_good = rate >= LEAST_RATE and figures["megabytes"] < MOST_MEGABYTES
    print(
        f"{format_:8} {figures['rows']:>10,.0f} rows {rate:>10,.0f} rows/s "
        f"({figures['rows'] / figures['processor']:,.0f} of processor time) "
        f"{figures['bytes'] / 1e6:>8,.0f} MB {figures['megabytes']:>6,.0f} MB of memory"
        f"{'' if is_good else '   over the bound'}"
    )
    return is_good


def round_trip(site: Site, folder: Path) -> bool:
    """Write the pair files, import them into another world, write them again; return whether all are equal."""
    first, second = folder / "first", folder / "second"
    for name, *command in (
        ("export", "export_split", WORLD, "million", "--output", str(first)),
        ("import", "import_pairs", str(first), "--world", "again", "--name", "million"),
        ("export", "export_split", "again", "million-command", "--output", str(second)),
    ):
        spent = site.run(*command)
        if spent.status:
            sys.exit(spent.errors)
        print(
            f"{name:8} {spent.wall:>8.1f} s {spent.processor:>8.1f} s of processor time "
            f"{spent.peak / 2**20:>6,.0f} MB of memory"
        )
    paths = sorted(path.relative_to(first) for path in first.rglob("*.txt"))
    is_same = paths == sorted(path.relative_to(second) for path in second.rglob("*.txt"))
    is_same &= all(filecmp.cmp(first / path, second / path, shallow=False) for path in paths)
    size = sum((first / path).stat().st_size for path in paths)
    verdict = "the same, byte for byte" if is_same else "NOT THE SAME"
    print(f"{ROUND_TRIP:8} {len(paths)} files of {size / 1e6:,.0f} MB: {verdict}")
    return is_same


def measured_apart(folder: Path, database: str, format_: str) -> dict[str, float]:
    """Measure one format in a process of its own, whose peak of memory is nobody else's."""
    arguments = ["--keep", str(folder), "--database", database, "--measure", format_]
    command = [sys.executable, "-m", "benchmarks.exports", *arguments]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=True, text=True)
    return dict(json.loads(done.stdout.splitlines()[-1]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--examples", type=int, default=1_000_000)
    parser.add_argument("--only", choices=(*FORMATS, ROUND_TRIP))
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--database", default="")
    parser.add_argument("--measure", choices=FORMATS, help=argparse.SUPPRESS)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="exports-") as made:
        folder = options.keep or Path(made)
        is_filled = (folder / "db.sqlite3").exists() or bool(options.keep and options.database)
        site = Site(folder, options.database)
        if options.measure:
            print(json.dumps(measure(site, options.measure)))
            return
        if not is_filled:
            fill(site, options.examples)
        formats = [options.only] if options.only else FORMATS
        good = [
            report(file_format, measured_apart(folder, options.database, file_format))
            for file_format in formats
            if file_format != ROUND_TRIP
        ]
        if options.only in (None, ROUND_TRIP):
            with tempfile.TemporaryDirectory(prefix="pairs-") as pairs:
                good.append(round_trip(site, Path(pairs)))
    sys.exit(0 if all(good) else 1)


if __name__ == "__main__":
    main()
