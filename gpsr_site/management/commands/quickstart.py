"""Everything between an installed project and a page in the browser; ``make run`` calls it."""

from __future__ import annotations

import secrets
import threading
import time
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management import call_command
from django.core.management.base import BaseCommand, CommandError
from django.db import IntegrityError, transaction

from annotations.exchange.starter_world import STARTER_WORLD, load_starter_world
from annotations.language.corpus import Criterion
from annotations.models import Split, User, World
from annotations.people.audit_log import record_command
from gpsr_site.processes import PARSE_SERVER, Supervisor, web_server_commands, worker_command
from gpsr_site.web.server import require_free_port
from parser_service.runs.first_runs import request_first_runs

HEALTH_PATIENCE_SECONDS = 60


class Command(BaseCommand):
    help = (
        "Prepare the database, load the starter world, create an admin on the first start, "
        "then serve the pages and run two workers and the parse server until stopped; one worker trains, one "
        "does short work."
    )
    requires_system_checks = []  # they load all pages; the web server makes them before it serves

    def handle(self, *args: Any, **options: Any) -> None:
        self.refuse_a_taken_port()
        call_command("migrate", interactive=False, verbosity=0)
        call_command("collectstatic", interactive=False, verbosity=0)
        request_first_runs(self.load_world())
        later = {
            "training worker": worker_command("cpu", "gpu"),
            "quick worker": worker_command("quick"),
        }
        if not settings.PARSER_IS_ELSEWHERE:
            later["parse server"] = PARSE_SERVER
        # People wait for the first page, so the others leave it the cores.
        is_announced = threading.Event()
        web_servers = web_server_commands(settings.WEB_PROCESSES)
        supervisor = Supervisor(web_servers, self.say, later, is_announced.is_set, self.log)
        supervisor.start()
        threading.Thread(target=self.announce, args=[is_announced], daemon=True).start()
        supervisor.watch()
        self.say("Stopped.")

    def say(self, sentence: str) -> None:
        self.stdout.write(sentence)
        self.stdout.flush()

    @property
    def log(self) -> Path | None:
        """The file that the parts write to where a person reads the output, which ends with how to log in."""
        return settings.VAR_DIR / "quickstart.log" if self.stdout.isatty() else None

    @property
    def address(self) -> str:
        return f"http://{settings.HOST}:{settings.PORT}/"

    def refuse_a_taken_port(self) -> None:
        try:
            require_free_port(settings.HOST, settings.PORT)
        except OSError as error:
            raise CommandError(
                f"Cannot serve on {settings.HOST}:{settings.PORT}: {error.strerror}. "
                f"Stop what uses it, or choose another port: PORT={settings.PORT + 1} make run"
            ) from error

    def create_admin(self) -> str:
        """Make the first administrator where there is none. Return how to log in, which nobody is told again."""
        if User.objects.filter(is_superuser=True).exists():
            return ""
        password = secrets.token_urlsafe(12)
        try:
            with transaction.atomic():
                User.objects.create_superuser("admin", password=password)
        except IntegrityError:
            return "There is an account “admin” already; gpsr-workbench manage createsuperuser makes another."
        record_command("make an account", "admin, administrator of the site")
        return (
            f"Log in as: admin   password: {password}\n"
            "The password is not shown again; change it with: gpsr-workbench manage changepassword admin"
        )

    def load_world(self) -> dict[Criterion, Split]:
        """Load the starter world, where it is not there, and return its splits."""
        is_new = not World.objects.filter(name=STARTER_WORLD).exists()
        splits = load_starter_world(self.say)
        if is_new:
            world = World.objects.get(name=STARTER_WORLD)
            record_command("create a world", "the starter world", world)
        return splits

    def announce(self, is_announced: threading.Event) -> None:
        """Print the address once the web server answers, and set the event then, or after a minute."""
        deadline = time.monotonic() + HEALTH_PATIENCE_SECONDS
        while not (answers := self.answers()) and time.monotonic() < deadline:
            time.sleep(0.2)
        if answers:
            where = f"GPSR Workbench is at {self.address} (Ctrl-C stops it)"
        else:
            where = f"The web server has not answered at {self.address} for a minute."
        parts = f"The parts write to {self.log}" if self.log else ""
        # At once, so that nothing comes between the address and the password.
        self.say("\n".join(filter(None, (parts, where, self.create_admin()))))
        is_announced.set()

    def answers(self) -> bool:
        """Return whether the web server answers at all; what it answers is the page's business."""
        try:
            urllib.request.urlopen(f"{self.address}healthz", timeout=2).close()
        except urllib.error.HTTPError:
            return True
        except OSError:
            return False
        return True
