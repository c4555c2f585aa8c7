"""``manage.py work``: one worker."""

from __future__ import annotations

import logging
import os
import sys
from socket import gethostname
from typing import Any

from django.core.management.base import BaseCommand, CommandParser

from annotations.background import message_queue, queue_app
from annotations.models.background import Queue


class Command(BaseCommand):
    help = (
        "Carry out queued runs and jobs, one at a time, until stopped (Ctrl-C or SIGTERM, within "
        "5 seconds)."
    )
    requires_system_checks = []

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument(
            "--queue",
            nargs="+",
            choices=Queue.values,
            default=Queue.values,
            help="which work to take: training on the processor (cpu) or on a GPU (gpu), imports and "
            "parsers that train in seconds (quick). Without it: all of them",
        )

    def handle(self, *args: Any, queue: list[str], **options: Any) -> None:
        os.environ.setdefault("CELERY_SKIP_CHECKS", "1")  # they load the pages, which train nothing
        # Not by Celery's command line, which loads a shell with its prompt besides.
        worker = queue_app().Worker(
            hostname=f"{'-'.join(queue)}-{os.getpid()}@{gethostname()}",
            queues=[message_queue(each) for each in queue],
            loglevel=logging.getLevelName(logging.getLogger().level),
            quiet=True,
            without_gossip=True,
            without_mingle=True,
            without_heartbeat=True,
        )
        worker.start()
        sys.exit(worker.exitcode)
