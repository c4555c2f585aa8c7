"""How log lines look, and what never stands in them."""

from __future__ import annotations

import logging
import re

SECRET_ADDRESS = re.compile(r"(/join/)[^/\s?]+")


class HideSecrets(logging.Filter):
    """Replaces the secrets of links, which stand in the addresses of requests, by three dots."""

    def filter(self, record: logging.LogRecord) -> bool:
        message = record.getMessage()
        hidden = SECRET_ADDRESS.sub(r"\1…", message)
        if hidden != message:
            record.msg, record.args = hidden, ()
        return True
