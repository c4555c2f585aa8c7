"""The installation: settings, routes and what looks at both apps."""

import gc

gc.disable()  # until all apps are loaded (``SiteConfig.ready``)

from gpsr_site.celery import app as celery_app  # noqa: E402

__all__ = ["celery_app"]
