#!/usr/bin/env python
"""Django's command line for GPSR Workbench."""

import gc
import os
import sys


def main() -> None:
    gc.disable()  # until all apps are loaded: see SiteConfig.ready
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
    from django.core.exceptions import ImproperlyConfigured
    from django.core.management import execute_from_command_line

    try:
        execute_from_command_line(sys.argv)
    except ImproperlyConfigured as error:
        if "--traceback" in sys.argv:
            raise
        sys.exit(str(error))


if __name__ == "__main__":
    main()
