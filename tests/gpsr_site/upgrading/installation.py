"""An installation of commit 7eb91d0, the oldest that is upgraded: a dump of its database with a small world, in which
people have left labels, comments, reviews, dialogues, a campaign and a token.

``7eb91d0.sqlite.sql.gz`` is the output of ``.dump``, ``7eb91d0.postgresql.sql.gz`` that of ``pg_dump --inserts``. Both
lack the rows of content types and permissions, which ``migrate`` makes anew.
"""

from __future__ import annotations

import gzip
import os
import secrets
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import psycopg

from tests.annotations.commands.run_command import ROOT
from tests.migrated import DATABASE


@dataclass(frozen=True)
class Installation:
    folder: Path
    url: str
    connect: Callable[[], Any]

    def manage(self, *arguments: object) -> subprocess.CompletedProcess[str]:
        """Run a command in a process of its own."""
        return self.python("manage.py", *arguments)

    def python(self, *arguments: object) -> subprocess.CompletedProcess[str]:
        """Run Python with the settings of this installation."""
        return subprocess.run(
            [sys.executable, *map(str, arguments)],
            cwd=ROOT,
            env={**os.environ, "GPSR_VAR_DIR": str(self.folder), "DATABASE_URL": self.url},
            capture_output=True,
            text=True,
            check=False,
        )

    def execute(self, statement: str) -> list[tuple[Any, ...]]:
        """Return the rows of a query, or commit another statement."""
        with closing(self.connect()) as opened, opened:
            cursor = opened.execute(statement)
            return cursor.fetchall() if cursor.description else []


def dump_of(vendor: str) -> str:
    path = Path(__file__).with_name(f"7eb91d0.{vendor}.sql.gz")
    return gzip.decompress(path.read_bytes()).decode()


@contextmanager
def installed(vendor: str, folder: Path) -> Iterator[Installation]:
    """Install 7eb91d0 in ``folder``, or on the server of ``TEST_DATABASE_URL``."""
    if vendor == "sqlite":
        path = folder / DATABASE
        with closing(sqlite3.connect(path)) as opened:
            opened.executescript(dump_of(vendor))
        yield Installation(folder, f"sqlite:///{path}", lambda: sqlite3.connect(path))
        return
    server = urlsplit(os.environ["TEST_DATABASE_URL"])
    name = f"upgrading_{secrets.token_hex(4)}"
    url = server._replace(path=f"/{name}").geturl()
    with psycopg.connect(server._replace(path="/postgres").geturl(), autocommit=True) as opened:
        opened.execute(f"CREATE DATABASE {name}")
        try:
            with psycopg.connect(url) as filled:
                filled.execute(dump_of(vendor))
            yield Installation(folder, url, lambda: psycopg.connect(url))
        finally:
            opened.execute(f"DROP DATABASE {name} WITH (FORCE)")
