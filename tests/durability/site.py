"""A site of its own whose web server can be killed, and what its database holds afterwards."""

from __future__ import annotations

import json
import os
import signal
import socket
import sqlite3
import subprocess
import sys
import time
from http.client import HTTPConnection
from pathlib import Path
from urllib.parse import urlencode

ROOT = Path(__file__).resolve().parents[2]
STARTUP_SECONDS = 120
MOST_PORTS = 3
CSRF = "a" * 32
# Makes a world with some templates and somebody who is logged in; prints what a browser of theirs knows.
FILL = """
import json
from django.test import Client
from annotations.exchange.generator_import import import_generator
from annotations.models import Membership, SemanticTemplate, User, World
from tests.annotations.conftest import TINY, as_bytes
import_generator("home", as_bytes(TINY))
user = User.objects.create_user("anna")
Membership.objects.create(world=World.objects.get(), user=user, role="annotator")
client = Client()
client.force_login(user)
first = SemanticTemplate.objects.first()
for position in range(2, {templates}):
    first.pk, first.position = None, position
    first.save()
keys = list(SemanticTemplate.objects.values_list("pk", flat=True))
print(json.dumps({{"user": user.pk, "session": client.cookies["sessionid"].value, "templates": keys}}))
"""


def free_port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


class KillableSite:
    """A migrated installation in ``folder`` with a world of so many ``templates``."""

    def __init__(self, folder: Path, templates: int) -> None:
        self.folder = folder
        self._environment = {
            **os.environ,
            "GPSR_VAR_DIR": str(folder),
            "HOST": "127.0.0.1",
            "LOG_LEVEL": "ERROR",
        }
        self._environment.pop("DATABASE_URL", None)
        filled = json.loads(self._manage("shell", "-v0", "-c", FILL.format(templates=templates)))
        self.user, self.templates = filled["user"], filled["templates"]
        self._cookies = f"sessionid={filled['session']}; csrftoken={CSRF}"

    def _manage(self, *arguments: str) -> str:
        command = [sys.executable, "manage.py", *arguments]
        ran = subprocess.run(
            command, cwd=ROOT, env=self._environment, check=True, stdout=subprocess.PIPE, text=True
        )
        return ran.stdout

    def start(self) -> None:
        """Start the web server and wait until it answers."""
        for _ in range(
            MOST_PORTS
        ):  # another process may take a port between its choice and its use
            if self._starts_on(free_port()):
                return
        raise RuntimeError((self.folder / "serve.log").read_text(encoding="utf-8")[-2000:])

    def _starts_on(self, port: int) -> bool:
        self.port = port
        with (self.folder / "serve.log").open("ab") as log:
            self._process = subprocess.Popen(
                [sys.executable, "manage.py", "serve"],
                cwd=ROOT,
                env={**self._environment, "PORT": str(port)},
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
        deadline = time.monotonic() + STARTUP_SECONDS
        while time.monotonic() < deadline:
            try:
                self.ask("GET", "/healthz")
                return self._process.poll() is None
            except OSError:
                if self._process.poll() is not None:
                    return False
                time.sleep(0.05)
        return False

    def kill(self) -> None:
        """Send SIGKILL to the web server, whatever it is doing."""
        os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()

    def ask(self, method: str, path: str, body: bytes = b"", kind: str = "") -> tuple[int, bytes]:
        """Send a request as the annotator; return the status and the answer. Raises OSError."""
        connection = HTTPConnection("127.0.0.1", self.port, timeout=60)
        headers = {"Cookie": self._cookies, "X-CSRFToken": CSRF, "Content-Type": kind}
        try:
            connection.request(method, path, body, headers)
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def save_template(self, pk: int, pattern: str, version: int) -> bool:
        """Send the form of a template; return whether the server said that it is saved."""
        form = {"pattern": pattern, "form": "(go {room})", "status": "draft", "version": version}
        path = f"/w/home/templates/{pk}/"
        kind = "application/x-www-form-urlencoded"
        return self.ask("POST", path, urlencode(form).encode(), kind)[0] == 302

    def save_draft(self, pk: int, pattern: str) -> bool:
        """Send a draft; return whether the server said that it is kept."""
        fields = {"pattern": pattern}
        sent = {"of": self.user, "fields": fields, "version": 1, "device": "a"}
        path, kind = f"/w/home/drafts/template/{pk}/", "application/json"
        status, answer = self.ask("POST", path, json.dumps(sent).encode(), kind)
        return status == 200 and bool(json.loads(answer)["saved_at"])

    def read(self, query: str, *values: object) -> list[tuple]:
        """Ask the database itself."""
        with sqlite3.connect(self.folder / "db.sqlite3", timeout=60) as database:
            return database.execute(query, values).fetchall()
