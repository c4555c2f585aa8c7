"""A fresh installation, to run commands on and measure what each of them costs."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import django

ROOT = Path(__file__).resolve().parent.parent
DATA = Path(os.environ.get("GPSR_SHARED_DATA", ROOT.parent / "shared" / "data")).resolve()
WORLD = "gpsr2018"


@dataclass(frozen=True, slots=True)
class Spent:
    """What one command cost: exit status, seconds of processor time (user and system) and of wall time, peak
    memory in bytes, and what it wrote to standard error."""

    status: int
    processor: float
    wall: float
    peak: int
    errors: str


class Site:
    """A SQLite database in ``folder``, or the one that ``database`` names by its address. Encoders are looked for
    where the environment says."""

    def __init__(self, folder: Path, database: str = ""):
        self.environment = {**os.environ, "GPSR_VAR_DIR": str(folder)}
        var = os.environ.get("GPSR_VAR_DIR", str(ROOT / "var"))
        self.environment.setdefault("GPSR_ENCODERS_DIR", str(Path(var).resolve() / "encoders"))
        self.environment.pop("DATABASE_URL", None)
        if database:
            self.environment["DATABASE_URL"] = database
        self.migrated = self.run("migrate", "-v0")
        if self.migrated.status:
            sys.exit(self.migrated.errors)

    def run(self, *arguments: str) -> Spent:
        """Run ``manage.py`` in a process of its own. This process has to stay small: the peak that the
        kernel reports starts at the size of the process that was forked."""
        began = time.perf_counter()
        with tempfile.TemporaryFile() as errors:
            child = subprocess.Popen(
                [sys.executable, "manage.py", *arguments],
                cwd=ROOT,
                env=self.environment,
                stdout=subprocess.DEVNULL,
                stderr=errors,
            )
            _, status, usage = os.wait4(child.pid, 0)
            wall = time.perf_counter() - began
            child.returncode = os.waitstatus_to_exitcode(status)
            errors.seek(0)
            text = errors.read().decode("utf-8", "replace")
        processor = usage.ru_utime + usage.ru_stime
        return Spent(child.returncode, processor, wall, usage.ru_maxrss * 1024, text)

    def enter(self) -> None:
        """Make this process one of the installation, so that it can read its world."""
        if "DATABASE_URL" not in self.environment:
            os.environ.pop("DATABASE_URL", None)
        os.environ.update(self.environment, DJANGO_SETTINGS_MODULE="gpsr_site.settings")
        django.setup()

    def import_world(self) -> None:
        """Import the published generator as ``WORLD``, which *domain* and *grammar* read. Exits if refused."""
        made = self.run("import_generator", str(DATA / "generator-2018"), "--world", WORLD)
        if made.status:
            sys.exit(made.errors)
