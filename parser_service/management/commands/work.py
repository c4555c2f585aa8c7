"""``manage.py work``: one worker."""

from __future__ import annotations

import logging
import os
from typing import Any

from celery import current_app
from django.core.management.base import BaseCommand, CommandParser

from parser_service.models.runs import Queue
from parser_service.waking import message_queue


class Command(BaseCommand):
    help = "Train queued runs, one at a time, until stopped (Ctrl-C or SIGTERM, within 5 seconds)."
    requires_system_checks = []

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument(
            "--queue",
            choices=Queue.values,
            default=Queue.CPU,
            help="which runs to train: those that need no GPU (cpu) or those that do (gpu)",
        )

    def handle(self, *args: Any, queue: str, **options: Any) -> None:
        os.environ.setdefault("CELERY_SKIP_CHECKS", "1")  # they load the pages, which train nothing
        level = logging.getLevelName(logging.getLogger().level)
        current_app.worker_main(
            [
                "--quiet",
                "worker",
                f"--queues={message_queue(queue)}",
                f"--hostname={queue}-{os.getpid()}@%h",
                f"--loglevel={level}",
                "--without-gossip",
                "--without-mingle",
                "--without-heartbeat",
            ]
        )
