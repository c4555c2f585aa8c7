"""/api/v1/worlds/<w>/runs/<r>/findings/ and probes/, utterances/<u>/candidates/"""

from __future__ import annotations

import pytest

from annotations.background.progress import UNWATCHED
from annotations.labelling.collecting import collect
from annotations.models import ApiToken, Job, JobKind, Scope, Utterance
from parser_service.reviews.analysis_job import analyse
from tests.filled_world import save_parser

HOME = "/api/v1/worlds/home/"


@pytest.fixture
def read(client, annotator):
    _, key = ApiToken.issue(annotator, "notebook", scope=Scope.READ)
    return lambda path: client.get(HOME + path, headers={"authorization": f"Bearer {key}"})


def test_before_an_analysis_nothing_is_known(read, sample):
    answer = read(f"runs/{sample.run.pk}/findings/").json()
    assert (answer["findings"], answer["is_complete"], answer["job"]) == ({}, False, None)
    assert read(f"runs/{sample.run.pk}/findings/?part=moon").status_code == 400
    assert read(f"runs/{sample.run.pk}/probes/").json()["results"] == []


def test_what_an_analysis_has_found_is_read(read, sample):
    save_parser(sample.run)
    analyse(
        Job(world=sample.world, kind=JobKind.ANALYSE, arguments={"run": sample.run.pk}), UNWATCHED
    )
    answer = read(f"runs/{sample.run.pk}/findings/").json()
    assert answer["is_complete"] and answer["part"] == answer["parts"][0]
    assert {"attractors", "risk_coverage"} <= set(answer["findings"])
    probes = read(f"runs/{sample.run.pk}/probes/?limit=1000").json()["results"]
    assert len(probes) == sample.run.probes.filter(answer__isnull=False).count() > 0
    some = read(f"runs/{sample.run.pk}/probes/?kind={probes[0]['kind']}").json()["results"]
    assert {each["kind"] for each in some} == {probes[0]["kind"]}


def test_the_forms_that_an_utterance_may_have_are_offered(read, sample, annotator):
    collect(sample.world, ["go to the kitchen"], by=annotator)
    row = Utterance.objects.get()
    (first, *_) = read(f"utterances/{row.pk}/candidates/").json()["results"]
    assert (first["form"], first["sources"][0]) == ('( go " <room> " )', "grammar")
    assert read("utterances/1000000/candidates/").status_code == 404
