"""The manifest of an exported split: it says later what was trained or tested on."""

from __future__ import annotations

import subprocess
from functools import cache
from importlib.metadata import version
from typing import Any

from django.conf import settings
from django.db.models import Count

from annotations.language.corpus import Part
from annotations.models import Split
from annotations.models.splits import Source

FORMAT, VERSION = "gpsr-workbench-split", 1
GIT_SECONDS = 5


def manifest_of(split: Split, part: str | None = None, source: str | None = None) -> dict[str, Any]:
    """Return hash, criterion and origin of ``split``, and how many examples of a part and source it has."""
    chosen = {name: value for name, value in (("part", part), ("source", source)) if value}
    rows = split.examples.filter(**chosen).order_by().values_list("source", "part")
    counted = {(of, where): count for of, where, count in rows.annotate(Count("pk"))}
    counts = {str(of): {str(where): counted.get((of, where), 0) for where in Part} for of in Source}
    return {
        "format": FORMAT,
        "version": VERSION,
        "world": split.world.name,
        "split": split.name,
        "criterion": split.criterion,
        "seed": split.seed,
        "proportions": split.proportions,
        "tests_on_models": split.tests_on_models,
        "sample": split.sample or None,
        "content_hash": split.content_hash,
        "created_at": split.created_at.isoformat(),
        "chosen": chosen,
        "counts": counts,
        "examples": sum(counted.values()),
        "code_version": code_version(),
    }


@cache
def code_version() -> str:
    """Return the release of this program, with the commit where it runs from a checkout: ``1.0.0+4f2c91a``."""
    release = version("gpsr-workbench")
    if not settings.IS_CHECKOUT:  # a repository around the environment is another one
        return release
    try:
        asked = subprocess.run(
            ["git", "rev-parse", "--short", "HEAD"],
            cwd=settings.BASE_DIR,
            capture_output=True,
            text=True,
            timeout=GIT_SECONDS,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return release
    return f"{release}+{asked.stdout.strip()}"
