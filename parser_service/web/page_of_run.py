"""What the pages about one run have at their head (``page_of_run.html``)."""

from __future__ import annotations

from typing import Any

from parser_service.models import TrainingRun
from parser_service.parsers.registry import title_of
from parser_service.results.table_parts import marked


def head_of(run: TrainingRun, title: str) -> dict[str, Any]:
    """Return the run, the title of the page and what stands beside it, for the context of a template."""
    parser = marked(title_of(run.parser), run.parser)
    return {"run": run, "title": title, "aside": f"{parser}, run {run.pk}"}
