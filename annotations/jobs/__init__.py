"""Verbs that a worker carries out because they take over a second: imports, generation, deletion.

A request asks for a job with its files (``request_job``), or is quick enough to be answered at once
(``weight`` says which). The worker calls the same verbs, which tell of their progress and write in a
transaction that only the holder of the job can commit.
"""

from annotations.jobs.requesting import answer_job, cancel_job, request_job, request_job_once

__all__ = [
    "answer_job",
    "cancel_job",
    "request_job",
    "request_job_once",
]
