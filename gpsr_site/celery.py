"""The Celery application: one process for one piece of work, and the timer in the worker's parent."""

from __future__ import annotations

import os

from celery import Celery

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")

app = Celery("gpsr_site")
app.config_from_object("django.conf:settings", namespace="CELERY")
app.conf.update(
    task_ignore_result=True,
    worker_pool="prefork",
    worker_concurrency=1,
    worker_prefetch_multiplier=1,
    worker_max_tasks_per_child=1,
    worker_enable_remote_control=False,
    worker_hijack_root_logger=False,
    worker_consumer="gpsr_site.consumer:PatientConsumer",
    worker_lost_wait=1.0,  # until a child that ended is known to be lost; a result of it is ignored anyway
    broker_connection_retry=True,
    broker_connection_retry_on_startup=True,
    broker_connection_max_retries=None,  # for ever: a worker never ends because the broker is away
)
app.Task.Request = "gpsr_site.consumer:WakeUp"
app.autodiscover_tasks(["parser_service"], related_name="worker")
app.steps["worker"].add("parser_service.runs.worker:WorkerTimer")
