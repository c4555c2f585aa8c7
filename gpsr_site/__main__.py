"""The command line: ``gpsr-workbench``, ``python -m gpsr_site`` and, in a checkout, ``manage.py``."""

from __future__ import annotations

import gc
import os
import sys
from importlib.metadata import version

HELP = """\
usage: gpsr-workbench run                    start everything: pages, workers, parse server
       gpsr-workbench manage COMMAND …       one command, such as train, parse or backup
       gpsr-workbench manage help            all of them; each takes --help
       gpsr-workbench --version"""


def main() -> None:
    match sys.argv[1:]:
        case ["run", *options]:
            manage(["quickstart", *options])
        case ["manage", *options]:
            manage(options)
        case ["--version"]:
            print(version("gpsr-workbench"))
        case [] | ["--help" | "-h" | "help"]:
            print(HELP)
        case [word, *_]:
            print(f"There is no “{word}” here.\n{HELP}", file=sys.stderr)
            sys.exit(2)


def manage(arguments: list[str]) -> None:
    """Run one of Django's commands, ours among them; settings that cannot be, and a database that is away, are one
    sentence."""
    gc.disable()  # until all apps are loaded: see SiteConfig.ready
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
    from django.core.exceptions import ImproperlyConfigured
    from django.core.management import execute_from_command_line
    from django.db import OperationalError

    try:
        execute_from_command_line(["gpsr-workbench manage", *arguments])
    except ImproperlyConfigured as error:
        if "--traceback" in arguments:
            raise
        sys.exit(str(error))
    except OperationalError as error:
        if "--traceback" in arguments:
            raise
        from annotations.background.failures import database_sentence

        sys.exit(database_sentence(error))


def command_line(*arguments: str) -> list[str]:
    """Return what starts another process of this installation with a command of ``manage``."""
    return [sys.executable, "-m", "gpsr_site", "manage", *arguments]


if __name__ == "__main__":
    main()
