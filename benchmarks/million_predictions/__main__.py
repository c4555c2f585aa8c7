"""How long the pages of the error analysis take with a million predictions.

    .venv/bin/python -m benchmarks.million_predictions [--examples 200000] [--requests 50] [--keep FOLDER]
        [--database postgres://postgres@127.0.0.1:5432/million] [--only compare] [--propose]

Makes a world in a fresh installation: five runs of one split with 200,000 test examples, whose utterances and forms
are those of the published 2018 generator with a word of their own, first answers of which 60 to 92 % are right, and
a proposed error category for each wrong one. Then requests each page of ``PAGES`` 50 times through Django's test
client, each time with other filters, runs or places in the list, and prints the median and the 95th percentile of
the wall time in milliseconds, the slowest request, the same of the processor time of this process (on SQLite the whole
cost, on a machine that does something else as well), and its peak memory.

With ``--propose`` the error categories of the first run, whose training part has 50,000 more examples, are proposed
instead, and processor time, wall time and peak memory printed.

On PostgreSQL the database is made, and dropped in the end unless ``--keep`` is given. With ``--keep`` a folder that
holds an installation already is measured as it is.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psycopg

from benchmarks.fresh_site import DATA, ROOT, WORLD, Site
from benchmarks.million_predictions.filling import fill
from benchmarks.million_predictions.requesting import measure


def create_database(address: str) -> None:
    """Create the database that an address names. Exits where there is one, which might hold something."""
    server, _, name = address.rpartition("/")
    with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
        try:
            connection.execute(f'CREATE DATABASE "{name}"')
        except psycopg.errors.DuplicateDatabase:
            sys.exit(f"There is a database {name} already; name another one.")


def drop_database(address: str) -> None:
    server, _, name = address.rpartition("/")
    with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
        connection.execute(f'DROP DATABASE "{name}" WITH (FORCE)')


def propose() -> None:
    """Propose for the run with the most errors, which is the first one."""
    from annotations.background.progress import UNWATCHED
    from annotations.models import World
    from parser_service.reviews.attractor_findings import attractors_in
    from parser_service.reviews.category_proposals import propose_for_run
    from parser_service.reviews.stored_findings import findings_of

    run = World.objects.get(name=WORLD).runs.order_by("pk")[0]
    attractors = attractors_in(findings_of(run, "test"))
    began, used = time.perf_counter(), time.process_time()
    count = propose_for_run(run, attractors, UNWATCHED)
    wall, processor = time.perf_counter() - began, time.process_time() - used
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"proposing categories for {count:,} errors: {processor:.1f} s of processor time, "
        f"{wall:.1f} s, peak memory {peak:.0f} MiB, load {os.getloadavg()[0]:.1f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--examples", type=int, default=200_000)
    parser.add_argument("--requests", type=int, default=50)
    parser.add_argument("--database", default="")
    parser.add_argument("--keep", type=Path, help="folder of the installation")
    parser.add_argument("--only", default="", help="pages whose name has this in it")
    parser.add_argument("--propose", action="store_true", help="propose error categories instead")
    parser.add_argument("--fill", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    sys.path.insert(0, str(ROOT))
    os.environ["DJANGO_SETTINGS_MODULE"] = "gpsr_site.settings"
    if arguments.fill:
        return fill(arguments.examples)
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or Path(temporary)
        is_filled = (folder / "filled").exists()
        if arguments.database and not is_filled:
            create_database(arguments.database)
        folder.mkdir(parents=True, exist_ok=True)
        site = Site(folder, arguments.database)
        if not is_filled:
            prepare(site, arguments.examples)
            (folder / "filled").touch()
        site.enter()
        is_kept = True
        if arguments.propose:
            propose()
        else:
            is_kept = measure(arguments.requests, arguments.only)
        if arguments.database and not arguments.keep:
            from django.db import connection

            connection.close()
            drop_database(arguments.database)
    sys.exit(0 if is_kept else 1)


def prepare(site: Site, examples: int) -> None:
    """Fill the installation, in a process of its own, so that this one stays small."""
    if not DATA.is_dir():
        sys.exit(f"needs the published files (GPSR_SHARED_DATA), and {DATA} does not hold them")
    site.import_world()
    site.run("createcachetable")
    command = [
        sys.executable,
        "-m",
        "benchmarks.million_predictions",
        "--fill",
        f"--examples={examples}",
    ]
    began = time.perf_counter()
    if subprocess.run(command, cwd=ROOT, env=site.environment, check=False).returncode:
        sys.exit("The database could not be filled.")
    print(f"filled in {time.perf_counter() - began:.0f} s", flush=True)


if __name__ == "__main__":
    main()
