#!/usr/bin/env python
"""Django's command line for GPSR Workbench."""

import os
import re
import sys


def main() -> None:
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
    if "benchmark" in sys.argv[1:2]:
        # Django takes --settings for a module, before a command sees it; here it means what to
        # train and test on.
        sys.argv = [re.sub("^--settings(?==|$)", "--train-test", given) for given in sys.argv]
    from django.core.management import execute_from_command_line

    execute_from_command_line(sys.argv)


if __name__ == "__main__":
    main()
