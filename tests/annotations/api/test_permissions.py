from __future__ import annotations

import pytest
from django.http import Http404
from rest_framework.test import APIRequestFactory
from rest_framework.views import APIView

from annotations.api.permissions import DenyByDefault, HasDuty
from annotations.models import Duty


def allowed(user, world, duty):
    view = APIView(kwargs={"world": world.name})
    view.duty = duty
    request = APIRequestFactory().get("/")
    request.user = user
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
