"""The version of the code that made a figure."""

from __future__ import annotations

from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path

from django.conf import settings

DECIDING = ("annotations/language", "parser_service/parsers", "parser_service/neural")


@cache
def code_version() -> str:
    """Return the version of the package and twelve digits of the SHA-256 of all code that decides figures:
    the language core, the parsers and their networks."""
    digest = sha256()
    for folder in DECIDING:
        for path in sorted((Path(settings.BASE_DIR) / folder).rglob("*")):
            if path.suffix in (".py", ".lark"):
                digest.update(path.relative_to(settings.BASE_DIR).as_posix().encode())
                digest.update(path.read_bytes())
    return f"{_package_version()}+{digest.hexdigest()[:12]}"


def _package_version() -> str:
    try:
        return metadata.version("gpsr-workbench")
    except metadata.PackageNotFoundError:
        return "0"
