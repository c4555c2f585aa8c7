"""Where rows are stored, and how much may be uploaded."""

from __future__ import annotations

import os
from pathlib import Path

from gpsr_site.private_files import make_database_private
from gpsr_site.settings.places import VAR_DIR, env

DATABASES = {"default": env.db("DATABASE_URL", default=f"sqlite:///{VAR_DIR / 'db.sqlite3'}")}
if DATABASES["default"]["ENGINE"] == "django.db.backends.sqlite3":
    DATABASES["default"]["OPTIONS"] = {
        "transaction_mode": "IMMEDIATE",
        "timeout": 20,
        "init_command": "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;",
    }
    if DATABASES["default"]["NAME"] != ":memory:":
        make_database_private(Path(DATABASES["default"]["NAME"]))
else:
    DATABASES["default"]["CONN_MAX_AGE"] = 60
    DATABASES["default"]["CONN_HEALTH_CHECKS"] = True
    if DATABASES["default"]["ENGINE"] == "django.db.backends.postgresql":
        # A server that is away is known to be within seconds, also when its machine is gone.
        DATABASES["default"]["OPTIONS"] = {
            "connect_timeout": 5,
            "keepalives_idle": 10,
            "keepalives_interval": 5,
            "keepalives_count": 3,
            **DATABASES["default"].get("OPTIONS", {}),
        }
        # Waits in Python, where a request that is over its time can be interrupted.
        os.environ.setdefault("PSYCOPG_WAIT_FUNC", "wait_poll")
# Shared by all processes; holds what limits are counted by. More than fits cannot be counted within
# the time after which a count expires.
CACHES = {
    "default": {
        "BACKEND": "django.core.cache.backends.db.DatabaseCache",
        "LOCATION": "gpsr_site_cache",
        "OPTIONS": {"MAX_ENTRIES": 100_000},
    }
}
DEFAULT_AUTO_FIELD = "django.db.models.BigAutoField"

UPLOAD_MAX_BYTES = 20 * 1024 * 1024
UPLOAD_MAX_FILES = 64
# What an archive of a whole world may hold, unpacked.
ARCHIVE_MAX_BYTES = 500 * 1024 * 1024
ARCHIVE_MAX_FILES = 5_000
DATA_UPLOAD_MAX_MEMORY_SIZE = 1024 * 1024  # of a form without its files
DATA_UPLOAD_MAX_NUMBER_FILES = UPLOAD_MAX_FILES
