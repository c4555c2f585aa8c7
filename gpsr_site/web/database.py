"""Timeouts of PostgreSQL for pages. Workers have none, since their statements may be long."""

from __future__ import annotations

from django.db import connections

# Seconds: one statement; waiting for a lock; a transaction that does nothing.
STATEMENT_SECONDS = 30
LOCK_SECONDS = 10
IDLE_TRANSACTION_SECONDS = 60


def bound_statements() -> None:
    """Bound what every later connection of this process may do. The web process calls it first."""
    database = connections.settings["default"]
    if database["ENGINE"] != "django.db.backends.postgresql":
        return
    bounds = {
        "statement_timeout": STATEMENT_SECONDS,
        "lock_timeout": LOCK_SECONDS,
        "idle_in_transaction_session_timeout": IDLE_TRANSACTION_SECONDS,
    }
    options = " ".join(f"-c {name}={seconds}s" for name, seconds in bounds.items())
    given = database["OPTIONS"].get("options", "")
    database["OPTIONS"]["options"] = f"{given} {options}".strip()
