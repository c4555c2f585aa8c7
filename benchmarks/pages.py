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
"""

from __future__ import annotations

import argparse
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


def measure(addresses: dict[str, str], least: float) -> dict[str, Cost]:
    """Request each address. Return what each of them costs."""
    from django.db import connection, transaction
    from django.test import Client

    from annotations.models import User
    from tests.database_work import counted_work

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
        request(path)
        status, costs[name] = request(path)
        if status >= 500:
            print(f"{name} answers {status}", flush=True)
        for seconds, sql in taken:
            if seconds >= least:
                print(f"{name}: {seconds:.2f} s  {sql[:1500]}", flush=True)
    return costs


def report(costs: dict[str, Cost], before: dict[str, Cost]) -> None:
    """Print the median and the worst of ``costs``, and what grew since ``before``."""
    each = sorted(cost.total for cost in costs.values())
    print(f"{len(each)} pages, median {statistics.median(each):.0f} ms, ", end="")
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
    parser.add_argument("--statements", type=float, default=60, help="seconds, of what is printed")
    parser.add_argument("--database", default="", help="an address of PostgreSQL; else SQLite")
    parser.add_argument("--keep", action="store_true", help="do not delete the world in the end")
    given = parser.parse_args()
    if given.database:
        create_database(given.database)
    with tempfile.TemporaryDirectory(prefix="pages-") as folder:
        try:
            site = Site(Path(folder), given.database)
            site.run("createcachetable")
            site.run("collectstatic", "--no-input", "-v0")
            site.enter()
            logging.disable()
            measure_all(given)
        finally:
            if given.database and not given.keep:
                drop_database(given.database)


def measure_all(given: argparse.Namespace) -> None:
    """Fill the world up to each size, and measure."""
    from django.db import transaction
    from django.test.utils import setup_test_environment

    from annotations.exchange.world_deletion import delete_world
    from tests.gpsr_site.routes.addresses import address
    from tests.gpsr_site.routes.test_queries import GET_ROUTES
    from tests.many_rows import ManyRows

    setup_test_environment()
    with transaction.atomic():
        sample = make_world()
    addresses = {name: address(name, sample) for name in GET_ROUTES if given.only in name}
    many = ManyRows(sample.world)
    costs: dict[str, Cost] = {}
    for size in given.sizes:
        began = time.perf_counter()
        fill(many, size)
        print(f"\n{size:,} rows of each kind, in {time.perf_counter() - began:.0f} s", end="")
        print(f", load {os.getloadavg()[0]:.1f}", flush=True)
        before, costs = costs, measure(addresses, given.statements)
        report(costs, before)
    if not given.keep:
        used = server_process()
        web, database = time.process_time(), used()
        rows = delete_world(sample.world)
        web, database = time.process_time() - web, (used() - database) / 1000
        print(f"\nthe deletion of {rows:,} rows: {web:.0f} s, of the database {database:.0f} s")


def fill(many: Any, size: int) -> None:
    """Copy rows; on PostgreSQL without looking at each key that one has of another, since all fit."""
    from django.db import connection, transaction

    with transaction.atomic(), connection.cursor() as cursor:
        if connection.vendor == "postgresql":
            cursor.execute("SET LOCAL session_replication_role = replica")
        many.multiply(size)
    with connection.cursor() as cursor:  # what autovacuum does within minutes
        cursor.execute("VACUUM ANALYZE" if connection.vendor == "postgresql" else "ANALYZE")


if __name__ == "__main__":
    main()
