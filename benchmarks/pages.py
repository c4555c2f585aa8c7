"""What each page and each REST list costs in a world with many rows of every kind.

    .venv/bin/python -m benchmarks.pages [--sizes 1000 100000 1000000] [--only queue] [--statements 0.1]
        [--database postgres://postgres@127.0.0.1:5432/pages]

Makes a fresh installation whose world has one of everything, and copies its rows until there are so many commands,
forms, paraphrases, utterances, work items, reviews, entries of the audit log, versions, comments and so on, and ten
times as many predictions; the description of the world, its splits, runs and people stay few. Requests every address
of the site that shows something of the world, as its admin, in this process, and prints the sum of all pages, the
median and the slowest, and each page that costs more than with fewer rows: milliseconds of processor time in the web
process; of the database, on PostgreSQL those of its server process, where it is on this machine (on SQLite it is this
process); statements; what the database read (``tests.database_work``). Each page is asked twice, and the second counts.
``--statements`` prints those that take longer than so many seconds. At last the world is deleted.

On PostgreSQL the database is made, and dropped in the end. Its server compares in one process (no parallel workers).
With ``--keep`` both stay, and a folder that holds an installation already is measured as it is.
"""

from __future__ import annotations

import argparse
import json
import logging
import os
import statistics
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.fresh_site import Site
from benchmarks.million_predictions.__main__ import create_database, drop_database

GROWN = 1.5  # times what a page costs with fewer rows
NOTICED = 20  # milliseconds: less is noise


@dataclass(frozen=True)
class Cost:
    """What one request costs: milliseconds here and in the database, statements, rows read."""

    web: float
    database: float
    statements: int
    rows: int

    @property
    def total(self) -> float:
        return self.web + self.database

    def __str__(self) -> str:
        return f"{self.web:8.0f}{self.database:9.0f} ms{self.statements:5}{self.rows:12,}"


def make_world() -> Any:
    """Make a world with one of everything, and an answer for each example. Return it as the tests' routes take it."""
    from annotations.models import User, World
    from annotations.models.worlds import Role
    from parser_service.models import Prediction
    from tests.conftest import member
    from tests.filled_world import leave_traces
    from tests.gpsr_site.routes.addresses import KEYS
    from tests.sample_world import answer, fill_world

    world = World.objects.create(name="home")
    sample = fill_world(world)
    admin = member(world, "adam", Role.ADMIN)
    leave_traces(world, member(world, "anna", Role.ANNOTATOR), admin)
    for make_rows in KEYS.values():
        make_rows(sample)
    answered = Prediction.objects.filter(run=sample.run).values("example")
    for example in sample.split.examples.exclude(pk__in=answered):
        answer(sample.run, example, example.logical_form)
    User.objects.filter(pk=admin.pk).update(is_superuser=True)
    return sample


def server_process() -> Callable[[], float]:
    """Return a function: the milliseconds of processor time that the database's process has used."""
    from django.db import connection

    if connection.vendor == "sqlite":
        return lambda: 0.0
    with connection.cursor() as cursor:
        cursor.execute("SET max_parallel_workers_per_gather = 0")
        cursor.execute("SELECT pg_backend_pid()")
        path = Path(f"/proc/{cursor.fetchone()[0]}/schedstat")
    return lambda: int(path.read_text().split()[0]) / 1e6


def measure(addresses: dict[str, str], given: argparse.Namespace) -> dict[str, Cost]:
    """Request each address that is asked for. Return what each of them costs."""
    from django.conf import settings
    from django.db import connection, transaction
    from django.test import Client

    from annotations.models import User
    from tests.database_work import counted_work

    settings.ALLOWED_HOSTS = ["testserver"]
    client, costs = Client(raise_request_exception=False), {}
    client.force_login(User.objects.get(username="adam"))
    used, taken = server_process(), []

    def note(execute: Any, sql: str, *arguments: Any) -> Any:
        began = time.perf_counter()
        try:
            return execute(sql, *arguments)
        finally:
            taken.append((time.perf_counter() - began, sql))

    def request(path: str) -> tuple[int, Cost]:
        """Request an address; undo what that writes."""
        taken.clear()
        with transaction.atomic(), counted_work() as work, transaction.atomic():
            web, database = time.process_time(), used()
            with connection.execute_wrapper(note):
                answer: Any = client.get(path)
                if answer.streaming:
                    b"".join(answer.streaming_content)
            web, database = time.process_time() - web, used() - database
            statements = len(taken)
            transaction.set_rollback(True)
        return answer.status_code, Cost(1000 * web, database, statements, work.done)

    for name, path in addresses.items():
        if given.only not in name or name in given.without:
            continue
        request(path)
        status, costs[name] = request(path)
        if status >= 500:
            print(f"{name} answers {status}", flush=True)
        for seconds, sql in taken:
            if seconds >= given.statements:
                print(f"{name}: {seconds:.2f} s  {sql[:1500]}", flush=True)
    return costs


def report(costs: dict[str, Cost], before: dict[str, Cost]) -> None:
    """Print the median and the worst of ``costs``, and what grew since ``before``."""
    each = sorted(cost.total for cost in costs.values())
    print(
        f"load {os.getloadavg()[0]:.1f}, {len(each)} pages, median {statistics.median(each):.0f} ms, ",
        end="",
    )
    print(f"95 % at most {each[int(0.95 * (len(each) - 1))]:.0f} ms, worst {each[-1]:.0f} ms")
    print("      web database statements rows read")
    for name, cost in sorted(costs.items(), key=lambda item: -item[1].total):
        least = before[name].total if before else 0
        if cost.total > GROWN * least + NOTICED:
            print(f"{cost}  {name}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[1_000, 100_000, 1_000_000])
    parser.add_argument("--only", default="", help="addresses whose name has this in it")
    parser.add_argument("--without", nargs="*", default=[], help="names of addresses to leave out")
    parser.add_argument("--statements", type=float, default=60, help="seconds, of what is printed")
    parser.add_argument("--database", default="", help="an address of PostgreSQL; else SQLite")
    parser.add_argument("--keep", type=Path, help="folder of the installation, which is kept")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="pages-") as temporary:
        folder = given.keep or Path(temporary)
        is_filled = (folder / "addresses.json").exists()
        if given.database and not is_filled:
            create_database(given.database)
        folder.mkdir(parents=True, exist_ok=True)
        try:
            site = Site(folder, given.database)
            site.run("createcachetable")
            site.run("collectstatic", "--no-input", "-v0")
            site.enter()
            logging.disable()
            if is_filled:
                addresses = json.loads((folder / "addresses.json").read_text())
                report(measure(addresses, given), {})
            else:
                (folder / "addresses.json").write_text(json.dumps(fill_and_measure(given)))
            if not given.keep:
                measure_deletion()
        finally:
            if given.database and not given.keep:
                drop_database(given.database)


def fill_and_measure(given: argparse.Namespace) -> dict[str, str]:
    """Fill the world up to each size, and measure. Return the addresses that are requested."""
    from django.db import transaction

    from tests.gpsr_site.routes.addresses import address
    from tests.gpsr_site.routes.test_queries import GET_ROUTES
    from tests.many_rows import ManyRows

    with transaction.atomic():
        sample = make_world()
    addresses = {name: address(name, sample) for name in GET_ROUTES}
    many = ManyRows(sample.world)
    costs: dict[str, Cost] = {}
    for size in given.sizes:
        began = time.perf_counter()
        fill(many, size)
        print(f"\n{size:,} rows of each kind, in {time.perf_counter() - began:.0f} s", flush=True)
        before, costs = costs, measure(addresses, given)
        report(costs, before)
    return addresses


def measure_deletion() -> None:
    from annotations.exchange.world_deletion import delete_world
    from annotations.models import World

    used = server_process()
    web, database = time.process_time(), used()
    rows = delete_world(World.objects.get())
    web, database = time.process_time() - web, (used() - database) / 1000
    print(f"\nthe deletion of {rows:,} rows: {web:.0f} s, of the database {database:.0f} s")


def fill(many: Any, size: int) -> None:
    """Copy rows. On PostgreSQL without looking at each key that one has of another, since all fit, and with the
    indexes made afterwards."""
    from django.db import connection, transaction

    is_postgresql = connection.vendor == "postgresql"
    with transaction.atomic(), connection.cursor() as cursor:
        if is_postgresql:
            cursor.execute("SET LOCAL session_replication_role = replica")
            cursor.execute(
                "SELECT indexname, indexdef FROM pg_indexes "
                "WHERE schemaname = 'public' AND indexdef NOT LIKE 'CREATE UNIQUE%'"
            )
            indexes = dict(cursor.fetchall())
            for name in indexes:
                cursor.execute(f'DROP INDEX "{name}"')
        many.multiply(size)
        if is_postgresql:
            for definition in indexes.values():
                cursor.execute(definition)
    with connection.cursor() as cursor:  # what autovacuum does within minutes
        cursor.execute("VACUUM ANALYZE" if is_postgresql else "ANALYZE")


if __name__ == "__main__":
    main()
