"""Single sign-on: there only where a server is named; it opens no door without an invitation or an account."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from django.conf import settings

ROOT = Path(__file__).resolve().parents[3]


def test_without_a_server_there_is_none(db, client):
    assert "allauth" not in settings.INSTALLED_APPS
    assert "Continue with" not in client.get("/login/").content.decode()
    assert client.post("/sso/site/login/").status_code in (302, 404)


@pytest.mark.processes
def test_with_a_server_people_sign_on(migrated_folder):
    pytest.importorskip("allauth")
    walk = [sys.executable, "-m", "tests.gpsr_site.accounts.sign_on_walk", str(migrated_folder)]
    done = subprocess.run(walk, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
