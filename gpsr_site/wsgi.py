"""The WSGI application that serves pages and API; it never imports torch."""

import os

from django.core.wsgi import get_wsgi_application
from django.urls import get_resolver

from gpsr_site import celery as celery  # now, not while the first message waits
from gpsr_site.web.database import bound_statements

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
application = get_wsgi_application()
bound_statements()
_ = get_resolver().url_patterns  # imports every view now, not while the first request waits
