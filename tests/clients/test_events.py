"""The client is told what ends in a world."""

from __future__ import annotations

from pytest_django.live_server_helper import LiveServer

from annotations.models import ApiToken, JobKind, World
from gpsr_client import Workbench
from tests.annotations.web.worlds.test_event_rest import end_job


def test_what_ends_is_yielded_and_goes_on_after_the_last(
    transactional_db, live_server: LiveServer, annotator, world: World
):
    _, token = ApiToken.issue(annotator, "robot", scope="read")
    home = Workbench(live_server.url, "home", token)
    begun = next(home.rows("jobs/"), None)
    listening = home.events(last="1", every=0)
    first, second = end_job(world), end_job(world, kind=JobKind.GENERATE)
    told = next(listening)
    assert begun is None
    assert (told["kind"], told["id"], told["status"]) == ("job", first.pk, "succeeded")
    assert next(home.events(told["event_id"]))["id"] == second.pk
    assert next(listening)["id"] == second.pk
