"""Twenty people write templates of the 2018 grammar at once: how long the checker takes to answer each.

    GPSR_SHARED_DATA=… .venv/bin/python -m tests.load.template_checks [--annotators 20] [--seconds 30] [--panel]

Starts a web server on a fresh SQLite installation with the published generator. Each annotator types published
templates word by word: a key every 0.2 s, and a check of what stands there 0.35 s after the last key of each word,
as the editor asks. With ``--panel`` each also asks for the preview and the consequences once
a template is whole. Says how long answers took at a client on the same machine; the promise is a 95th percentile of
150 ms for checks. Exits with 1 where an answer was an error.
"""

from __future__ import annotations

import argparse
import os
import random
import subprocess
import sys
import tempfile
import threading
import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from http.client import HTTPConnection
from pathlib import Path
from urllib.parse import urlencode

from tests.load.work_queue import ROOT, say, server

DATA = Path(os.environ.get("GPSR_SHARED_DATA", ROOT.parent / "shared" / "data"))
SECONDS_A_KEY = 0.2
QUIET_SECONDS = 0.35  # WAIT of static/src/editor-check.js
CSRF = "a" * 32


@dataclass(frozen=True)
class Setting:
    """What all annotators have in common. ``deadline`` in monotonic seconds; templates are (pattern, form)."""

    port: int
    category: int
    templates: list[tuple[str, str]]
    deadline: float
    asks_panels: bool


class Annotator(threading.Thread):
    """Types until the deadline. ``times`` are the seconds of each answer, by what was asked."""

    def __init__(self, number: int, session: str, setting: Setting) -> None:
        super().__init__(daemon=True)
        self.random = random.Random(number)
        self.setting = setting
        self.connection = HTTPConnection("127.0.0.1", setting.port, timeout=60)
        self.cookies = f"sessionid={session}; csrftoken={CSRF}"
        self.times: dict[str, list[float]] = defaultdict(list)
        self.errors: list[str] = []

    @property
    def is_over(self) -> bool:
        return time.monotonic() > self.setting.deadline

    def run(self) -> None:
        time.sleep(2 * self.random.random())
        while not self.is_over:
            pattern, form = self.random.choice(self.setting.templates)
            self.type_out(pattern, lambda text: self.ask("check", text, ""))
            self.type_out(form, lambda text, pattern=pattern: self.ask("check", pattern, text))
            if self.setting.asks_panels and not self.is_over:
                self.ask("preview", pattern, form)
                self.ask("consequences", pattern, form)

    def type_out(self, text: str, ask: Callable[[str], None]) -> None:
        words = text.split(" ")
        for number, word in enumerate(words, start=1):
            if self.is_over:
                return
            time.sleep(len(word) * SECONDS_A_KEY * self.random.uniform(0.5, 1.5) + QUIET_SECONDS)
            ask(" ".join(words[:number]))

    def ask(self, kind: str, pattern: str, form: str) -> None:
        fields = {"pattern": pattern, "form": form, "status": "ready"}
        fields["task_category"] = self.setting.category
        headers = {
            "Cookie": self.cookies,
            "X-CSRFToken": CSRF,
            "Content-Type": "application/x-www-form-urlencoded",
        }
        path = f"/w/gpsr2018/templates/{kind}/"
        began = time.perf_counter()
        self.connection.request("POST", path, urlencode(fields), headers)
        answer = self.connection.getresponse()
        answer.read()
        self.times[kind].append(time.perf_counter() - began)
        if answer.status != 200:
            self.errors.append(f"{kind} of {pattern} = {form}: {answer.status}")


def fill(people: int) -> tuple[list[str], int, list[tuple[str, str]]]:
    """Import the 2018 generator and sign people in: their sessions, a task category, the templates."""
    import django

    django.setup()
    from django.test import Client

    from annotations.exchange.generator_import import import_generator
    from annotations.generation.generating import generate_pairs
    from annotations.models import Membership, SemanticTemplate, TaskCategory, User, World

    import_generator("gpsr2018", DATA / "generator-2018")
    world = World.objects.get()
    generate_pairs(world)
    sessions = []
    for number in range(people):
        user = User.objects.create_user(f"annotator{number}")
        Membership.objects.create(world=world, user=user, role="annotator")
        client = Client()
        client.force_login(user)
        sessions.append(client.cookies["sessionid"].value)
    templates = list(SemanticTemplate.objects.values_list("pattern", "form"))
    return sessions, TaskCategory.objects.last().pk, templates


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--annotators", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--panel", action="store_true", help="ask for preview and consequences too")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="gpsr-load-") as folder:
        os.environ.update(GPSR_VAR_DIR=folder, DJANGO_SETTINGS_MODULE="gpsr_site.settings")
        os.environ.pop("DATABASE_URL", None)
        subprocess.run([sys.executable, "manage.py", "migrate", "-v0"], cwd=ROOT, check=True)
        sessions, category, templates = fill(options.annotators)
        with server() as (_, port):
            deadline = time.monotonic() + options.seconds
            setting = Setting(port, category, templates, deadline, options.panel)
            annotators = [Annotator(*each, setting) for each in enumerate(sessions)]
            for annotator in annotators:
                annotator.start()
            for annotator in annotators:
                annotator.join(options.seconds + 120)
    for kind in ("check", "preview", "consequences"):
        if times := [each for annotator in annotators for each in annotator.times[kind]]:
            say(kind, times)
    errors = [error for annotator in annotators for error in annotator.errors]
    print(f"{len(errors)} errors", *errors[:10], sep="\n")
    sys.exit(bool(errors))


if __name__ == "__main__":
    main()
