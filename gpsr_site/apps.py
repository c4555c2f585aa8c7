import gc

from django.apps import AppConfig


class SiteConfig(AppConfig):
    """The site around both apps: home, rail, banner, and the command that starts it all."""

    name = "gpsr_site"

    def ready(self) -> None:
        """Let forms speak plainly, and start the garbage collector, which ``manage.py`` has stopped.

        What is loaded stays to the end of the process. To look through it again and again while it
        is loaded takes a fifth of the time to start.
        """
        from gpsr_site.web.plain_messages import speak_plainly

        speak_plainly()
        gc.freeze()
        gc.enable()
