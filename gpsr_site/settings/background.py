"""Background work: the queue, and how fast its clocks go."""

from __future__ import annotations

from gpsr_site.settings.places import VAR_DIR, env

CELERY_BROKER_URL = env.str("CELERY_BROKER_URL", default="filesystem://localhost")
if CELERY_BROKER_URL.startswith("filesystem:"):
    for _name in ("messages", "control"):
        (VAR_DIR / "broker" / _name).mkdir(parents=True, exist_ok=True)
    CELERY_BROKER_TRANSPORT = "gpsr_site.broker:Transport"
    CELERY_BROKER_TRANSPORT_OPTIONS = {
        "data_folder_in": str(VAR_DIR / "broker" / "messages"),
        "data_folder_out": str(VAR_DIR / "broker" / "messages"),
        "control_folder": str(VAR_DIR / "broker" / "control"),
    }
# Sites that share a broker keep apart by it.
BROKER_QUEUE_PREFIX = env.str("GPSR_QUEUE_PREFIX", default="gpsr-")
# Divides every period of the background work (leases, timers): tests run at tempo 10.
WORK_TEMPO = env.float("GPSR_WORK_TEMPO", default=1.0)
