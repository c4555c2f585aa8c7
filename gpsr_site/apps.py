import gc

from django.apps import AppConfig
from django.core.checks import register


class SiteConfig(AppConfig):
    """The site around both apps: home, rail, banner, and the command that starts it all."""

    name = "gpsr_site"

    def ready(self) -> None:
        """Register the system check and the messages of forms, before any form is made. Start the garbage collector,
        which ``manage.py`` has stopped.

        What is loaded stays to the end of the process. To look through it again and again while it
        is loaded takes a fifth of the time to start.
        """
        from gpsr_site.web.plain_messages import speak_plainly

        speak_plainly()
        gc.freeze()
        gc.enable()
        from gpsr_site.backup.backup_checks import check_columns

        register(check_columns)
