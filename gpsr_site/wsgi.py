"""The WSGI application that serves pages and API; it never imports torch."""

import os

from django.core.wsgi import get_wsgi_application

from gpsr_site.web.database import bound_statements

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
application = get_wsgi_application()
bound_statements()
