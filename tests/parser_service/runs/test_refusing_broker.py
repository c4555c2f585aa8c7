"""A broker that answers and refuses does not fill the log of a worker."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from urllib.parse import urlsplit

import pytest

from tests.annotations.commands.run_command import ROOT

SECONDS = 12


@pytest.mark.processes
@pytest.mark.services
def test_a_worker_backs_off_where_its_virtual_host_is_gone(migrated_folder):
    address = os.environ.get("TEST_BROKER_URL", "")
    if not address.startswith("amqp"):
        pytest.skip("needs RabbitMQ (TEST_BROKER_URL)")
    environment = {
        **os.environ,
        "GPSR_VAR_DIR": str(migrated_folder),
        "CELERY_BROKER_URL": f"amqp://{urlsplit(address).netloc}/no-such-host",
    }
    environment.pop("DATABASE_URL", None)
    log = migrated_folder / "log"
    with log.open("wb") as file:
        worker = subprocess.Popen(
            [sys.executable, "manage.py", "work"], cwd=ROOT, env=environment, stderr=file
        )
        try:
            began = time.monotonic()
            while "refuses this worker" not in log.read_text():
                assert time.monotonic() - began < 120
                time.sleep(0.2)
            time.sleep(SECONDS)
            assert worker.poll() is None
        finally:
            worker.terminate()
            worker.wait(20)
    said = log.read_text()
    assert 2 <= said.count("refuses this worker") <= 5
    assert "Traceback" not in said and "Frequent restarts" not in said
