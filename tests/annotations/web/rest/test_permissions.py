from __future__ import annotations

import pytest
from django.http import Http404
from rest_framework.test import APIRequestFactory
from rest_framework.views import APIView

from annotations.models import ApiToken, Duty, Scope
from annotations.web.rest.permissions import DenyByDefault, HasDuty, scope_needed


def allowed(user, world, duty):
    view = APIView(kwargs={"world": world.name})
    view.duty = duty
    request = APIRequestFactory().get("/")
    request.user, request.auth = user, None
    return HasDuty().has_permission(request, view)


def test_a_route_without_a_permission_is_closed_to_everybody(superuser):
    request = APIRequestFactory().get("/")
    request.user = superuser
    assert not DenyByDefault().has_permission(request, APIView())


@pytest.mark.parametrize("duty", [Duty.ANNOTATE, Duty.MANAGE])
def test_a_duty_that_the_role_does_not_carry_is_denied(world, reviewer, duty):
    assert not allowed(reviewer, world, duty)


def test_a_duty_of_the_role_is_allowed(world, reviewer):
    assert allowed(reviewer, world, Duty.REVIEW)


def test_a_world_of_others_does_not_exist_for_a_stranger(world, stranger):
    with pytest.raises(Http404):
        allowed(stranger, world, Duty.VIEW)


@pytest.mark.parametrize(
    ("method", "duty", "scopes", "needed"),
    [
        ("GET", Duty.VIEW, {}, Scope.READ),
        ("POST", Duty.VIEW, {}, Scope.ANNOTATE),
        ("GET", Duty.ANNOTATE, {}, Scope.ANNOTATE),
        ("DELETE", Duty.REVIEW, {}, Scope.ANNOTATE),
        ("PUT", Duty.MANAGE, {}, Scope.ADMIN),
        ("POST", Duty.VIEW, {"POST": Scope.READ}, Scope.READ),
        ("POST", Duty.MANAGE, {"POST": Scope.TRAIN}, Scope.TRAIN),
        ("GET", Duty.VIEW, {"POST": Scope.TRAIN}, Scope.READ),
    ],
)
def test_duty_and_method_say_which_scope_a_token_needs(method, duty, scopes, needed):
    view = APIView()
    view.duty, view.scopes = duty, scopes
    assert scope_needed(view, method) == needed


@pytest.mark.parametrize(
    ("scope", "status"), [("read", 403), ("annotate", 201), ("train", 201), ("admin", 201)]
)
def test_a_token_does_no_more_than_its_scope_says(scope, status, annotator, client):
    _, key = ApiToken.issue(annotator, "notebook", scope=Scope(scope))
    headers = {"authorization": f"Bearer {key}"}
    url = "/api/v1/worlds/home/utterances/"
    assert client.get(url, headers=headers).status_code == 200
    sent = {"texts": ["bring me the tea"]}
    answer = client.post(url, sent, content_type="application/json", headers=headers)
    assert answer.status_code == status
    if status == 403:
        assert (
            "This token has the scope “read”, and this needs “annotate”." in answer.json()["detail"]
        )


def test_a_scope_gives_nobody_what_their_role_does_not(world, reviewer, client):
    _, key = ApiToken.issue(reviewer, "notebook", scope=Scope.ADMIN)
    sent, headers = {"texts": ["bring me the tea"]}, {"authorization": f"Bearer {key}"}
    url = "/api/v1/worlds/home/utterances/"
    answer = client.post(url, sent, content_type="application/json", headers=headers)
    assert answer.status_code == 403
