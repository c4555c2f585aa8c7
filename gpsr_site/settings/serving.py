"""Where the site is served, to whom, and how long a request may take."""

from __future__ import annotations

from ipaddress import ip_network

from django.core.exceptions import ImproperlyConfigured

from gpsr_site.secret_key import read_or_make_secret_key
from gpsr_site.settings.places import VAR_DIR, env

DEBUG = env.bool("DEBUG", default=False)
HOST = env.str("HOST", default="127.0.0.1")
PORT = env.int("PORT", default=8000)
LOCAL_HOSTS = ["localhost", "127.0.0.1", "[::1]"]
_is_local = HOST in ("localhost", "127.0.0.1", "::1")


def _required_when_served(name: str, example: str) -> None:
    """Stop the start with a sentence where a served installation lacks a variable."""
    if not (DEBUG or _is_local or env.str(name, default="")):
        raise ImproperlyConfigured(
            f"{name} is not set, and HOST={HOST} serves more than this machine. Set {name}, "
            f"for example {name}={example}, or serve on HOST=127.0.0.1."
        )


try:
    import annotations.language.english  # noqa: F401  it reads GPSR_ENGLISH_DIR
except ValueError as error:
    raise ImproperlyConfigured(str(error)) from error

_required_when_served("SECRET_KEY", "$(openssl rand -hex 32)")
_required_when_served("ALLOWED_HOSTS", "workbench.example.org")
SECRET_KEY = env.str("SECRET_KEY", default="") or read_or_make_secret_key(VAR_DIR / "secret_key")
ALLOWED_HOSTS = env.list("ALLOWED_HOSTS", default=LOCAL_HOSTS)
CSRF_TRUSTED_ORIGINS = env.list("CSRF_TRUSTED_ORIGINS", default=[])
HTTPS = env.bool("HTTPS", default=False)
# Whose X-Forwarded headers are believed; behind HTTPS there is a proxy, on this machine by default.
TRUSTED_PROXIES = [
    ip_network(each)
    for each in env.list("TRUSTED_PROXIES", default=["127.0.0.0/8", "::1"] if HTTPS else [])
]
# How long a request may take; what reads files or makes many rows may take ten times as long.
REQUEST_SECONDS = env.float("REQUEST_SECONDS", default=60)

# Web servers that share the port. One keeps one processor busy.
WEB_PROCESSES = env.int("WEB_PROCESSES", default=1)
