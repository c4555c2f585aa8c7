"""A worker that is killed while it asks a parser its probes: the next one goes on, and asks nothing twice."""

from __future__ import annotations

import pytest

from parser_service.models import ProbeAnswer
from parser_service.reviews.state import analysis_of
from parser_service.runs.analysis_requests import request_analysis
from tests.filled_world import save_parser
from tests.parser_service.worker_process import wait_for_status
from tests.waiting import wait_for

pytestmark = [pytest.mark.processes, pytest.mark.django_db(transaction=True)]


def test_an_analysis_outlives_its_worker(sample, start_worker):
    save_parser(sample.run)
    job = request_analysis(sample.run)
    worker = start_worker(sample.run.queue)
    wait_for(ProbeAnswer.objects.exists, "a probe is answered")
    worker.kill_child()
    before = dict(ProbeAnswer.objects.values_list("probe", "pk"))
    wait_for_status(job, "succeeded")
    answers = dict(ProbeAnswer.objects.values_list("probe", "pk"))
    assert before.items() <= answers.items()
    assert len(answers) == sample.run.probes.count()
    assert analysis_of(sample.run).is_complete
