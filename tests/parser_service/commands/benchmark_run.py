"""A run of ``manage.py benchmark``."""

from __future__ import annotations

import json
from pathlib import Path

from django.core.management import call_command


def run(folder: Path, file: Path, **options) -> list[dict]:
    named = {} if "columns" in options else {"criteria": "command", "protocols": "strict"}
    call_command("benchmark", str(folder), json=file, **{"parsers": "knn", **named, **options})
    return json.loads(file.read_text(encoding="utf-8"))
