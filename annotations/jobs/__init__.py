"""Verbs that a worker carries out because they take over a second: imports, generation, deletion.

A request asks for a job with its files (``request_job``), or is quick enough to be answered at once
(``weight`` says which). The worker calls the same verbs, which tell of their progress and write in a
transaction that only the holder of the job can commit.
"""

from annotations.jobs.files import forget_files, kept_uploads
from annotations.jobs.requesting import answer_job, cancel_job, keep_question, request_job
from annotations.jobs.weight import (
    is_heavy_deletion,
    is_heavy_generation,
    is_heavy_generator,
    is_heavy_pairs,
    is_heavy_world,
)

__all__ = [
    "answer_job",
    "cancel_job",
    "forget_files",
    "is_heavy_deletion",
    "is_heavy_generation",
    "is_heavy_generator",
    "is_heavy_pairs",
    "is_heavy_world",
    "keep_question",
    "kept_uploads",
    "request_job",
]
