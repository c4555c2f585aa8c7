"""A batch parsed as a job: the answers go into a file."""

from __future__ import annotations

import math
from typing import Any

from django.conf import settings

from annotations.background.job_files import kept_uploads, result_of
from annotations.background.progress import Progress
from annotations.models import Job
from parser_service.serving.lines import answer_lines
from parser_service.serving.metrics import Metrics
from parser_service.serving.preparing import numbered_lines
from parser_service.serving.shelf import Shelf


def parse_batch(job: Job, progress: Progress) -> dict[str, Any]:
    """Write the answer to each line into the file of results. Returns the report of the job.

    Raises Refusal where nothing answers in the world.
    """
    progress.report(0, "loading the parser")
    # Nobody waits for one answer: a language model may take as long as it needs.
    shelf = Shelf(settings.PARSER_MEMORY_MB * 1_000_000, Metrics(), patience=math.inf)
    answerer = shelf.load(job.world_name, job.arguments["run"], job.arguments.get("parser", ""))
    with kept_uploads(job) as (upload,):
        lines = upload.read()
    count, answered = len(numbered_lines(lines)), 0
    result = result_of(job)
    result.parent.mkdir(mode=0o700, exist_ok=True)
    beside = result.with_name(f"{result.name}.{job.attempt}.part")
    try:
        with beside.open("w", encoding="utf-8", errors="backslashreplace") as file:
            for answers in answer_lines(answerer, lines, job.arguments["beam"]):
                file.writelines(f"{answer}\n" for answer in answers)
                answered += len(answers)
                progress.report(answered / count, "parsing")
        beside.replace(result)
    finally:
        beside.unlink(missing_ok=True)
    return {"lines": count, "run": answerer.run, "parser": answerer.names}
