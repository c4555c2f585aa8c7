"""What importing, generating and refusing cost: processor time of whole commands, database included.

    GPSR_SHARED_DATA=… .venv/bin/python benchmarks/imports.py

Each command runs as a process of its own on a fresh SQLite database. The bound beside a figure is the
one the project promises.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DATA = Path(os.environ.get("GPSR_SHARED_DATA", ROOT.parent / "shared" / "data")).resolve()

# What is refused, as files of one folder.
FAULTS: dict[str, dict[str, bytes]] = {
    "a cycle": {"a.txt": b"$Main = $a\n$a = go $Main\n"},
    "a 5,000-deep parenthesis": {"a.txt": b"$Main = " + b"(" * 5000 + b"a" + b")" * 5000},
    "an entity bomb": {
        "objects.xml": b'<?xml version="1.0"?><!DOCTYPE x [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;">]>'
        b"<categories>&b;</categories>"
    },
    "a file outside the folder": {"a.txt": b"; import ../../etc/passwd\n$Main = go\n"},
    "a UTF-16 file": {"a.txt": "$Main = go\n".encode("utf-16")},
}


class Site:
    """A fresh database on which commands run one after another."""

    def __init__(self, folder: Path):
        self.environment = {**os.environ, "GPSR_VAR_DIR": str(folder)}
        self.environment.pop("DATABASE_URL", None)
        self.run("migrate", "-v0")

    def run(self, *arguments: str) -> tuple[int, float, float]:
        """Exit status, processor seconds (user and system) and wall seconds of one command."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        began = time.perf_counter()
        status = subprocess.run(
            [sys.executable, "manage.py", *arguments],
            cwd=ROOT,
            env=self.environment,
            capture_output=True,
            check=False,
        ).returncode
        wall = time.perf_counter() - began
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = (after.ru_utime - before.ru_utime) + (after.ru_stime - before.ru_stime)
        return status, spent, wall


def report(name: str, seconds: float, bound: float | None = None) -> None:
    verdict = (
        ""
        if bound is None
        else f"   (bound {bound:g} s: {'held' if seconds < bound else 'MISSED'})"
    )
    print(f"{seconds:8.2f} s  {name}{verdict}")


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        imported = site.run(
            "import_generator", str(DATA / "generator-2018"), "--world", "g", "--json"
        )
        generated = site.run("generate_pairs", "g", "--json")
        report("import_generator 2018, processor", imported[1])
        report("generate_pairs 2018, processor", generated[1])
        report("both", imported[1] + generated[1], 5.0)
        pairs = site.run("import_pairs", str(DATA / "walker2019"), "--world", "g", "--name", "w")
        report("import_pairs walker2019, processor", pairs[1])
        for name, files in FAULTS.items():
            bad = Path(folder) / name.replace(" ", "-")
            bad.mkdir()
            for file, data in files.items():
                (bad / file).write_bytes(data)
            status, _, wall = site.run("import_generator", str(bad), "--world", "bad", "--json")
            report(f"refuse {name}, wall, exit status {status}", wall, 2.0)


if __name__ == "__main__":
    main()
