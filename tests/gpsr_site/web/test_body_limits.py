"""Who may send how much, as the middleware sees it behind any server."""

from __future__ import annotations

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.models import ApiToken
from gpsr_site.web.body_limits import ANONYMOUS_BYTES, ORDINARY_BYTES

IMPORT = "/w/home/import/"


def send(client, path, size, **headers):
    return client.post(path, {"files": SimpleUploadedFile("a.txt", b"a" * size)}, headers=headers)


def test_nobody_sends_a_file_before_logging_in(db, client):
    answer = send(client, "/login/", ANONYMOUS_BYTES)
    assert answer.status_code == 413
    assert " 64 kB " in answer.content.decode()


@pytest.mark.parametrize("person", ["annotator", "reviewer", "stranger"])
def test_whoever_may_not_import_sends_no_files_there(person, world, client, request):
    client.force_login(request.getfixturevalue(person))
    assert send(client, IMPORT, ORDINARY_BYTES).status_code == 413


def test_an_admin_of_the_world_does(world, admin, client):
    client.force_login(admin)
    assert send(client, IMPORT, ORDINARY_BYTES).status_code in (
        302,
        422,
    )  # read, or left to a worker


def test_not_even_an_admin_sends_more_than_an_import_may_hold(world, admin, client, settings):
    client.force_login(admin)
    assert send(client, IMPORT, settings.UPLOAD_MAX_BYTES + 100_000).status_code == 413


def test_an_admin_sends_files_to_no_other_address(world, admin, client):
    client.force_login(admin)
    assert send(client, "/w/home/templates/new/", ORDINARY_BYTES).status_code == 413


def test_a_token_is_a_person_too(world, annotator, client):
    _, key = ApiToken.issue(annotator, "notebook")
    answer = send(client, "/api/v1/schema/", ANONYMOUS_BYTES, authorization=f"Bearer {key}")
    assert answer.status_code == 405
    answer = send(client, "/api/v1/schema/", ANONYMOUS_BYTES, authorization="Bearer wrong")
    assert answer.status_code == 413
    assert answer["Content-Type"] == "application/problem+json"


def test_a_whole_world_comes_from_administrators_of_the_site_alone(world, admin, superuser, client):
    client.force_login(admin)
    assert send(client, "/worlds/import/", ORDINARY_BYTES).status_code == 413
    client.force_login(superuser)
    assert send(client, "/worlds/import/", ORDINARY_BYTES).status_code == 422
