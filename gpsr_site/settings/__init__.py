"""The settings, one module a theme. Values come from the environment; without any it is a safe local
installation: SQLite and Celery's filesystem broker under ``var/``, served to this machine only.

Every variable read here stands in the README, and ``tests/test_docs.py`` holds the two together.
"""

# ruff: noqa: F403
from gpsr_site.settings.api import *
from gpsr_site.settings.applications import *
from gpsr_site.settings.background import *
from gpsr_site.settings.data import *
from gpsr_site.settings.logs import *
from gpsr_site.settings.parsing import *
from gpsr_site.settings.people import *
from gpsr_site.settings.places import *
from gpsr_site.settings.security import *
from gpsr_site.settings.serving import *
