"""The installation: settings, routes and what looks at both apps."""

from gpsr_site.celery import app as celery_app

__all__ = ["celery_app"]
