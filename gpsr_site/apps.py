from django.apps import AppConfig


class SiteConfig(AppConfig):
    """The site around both apps: home, rail, banner, and the command that starts it all."""

    name = "gpsr_site"
