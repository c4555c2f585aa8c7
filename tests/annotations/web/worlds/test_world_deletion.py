"""Deleting a world by page: an administrator of the site, with its name typed once more."""

from __future__ import annotations

import pytest
from django.urls import reverse

from annotations.models import World
from tests.notices import levels


@pytest.fixture
def root(superuser, client):
    client.force_login(superuser)
    return client


def test_what_would_go_is_counted(sample, root):
    page = root.get("/w/home/delete/").content.decode()
    assert "Commands</dt><dd>3</dd>" in page and "<dd>0</dd>" not in page
    assert "Entities</dt><dd>7</dd>" in page and "Entitys" not in page
    assert World.objects.filter(name="home").exists()


@pytest.mark.parametrize("name", ["", "Home", "laboratory", "home\0"])
def test_another_name_deletes_nothing(name, sample, root):
    assert root.post("/w/home/delete/", {"name": name}).status_code == 200
    assert World.objects.filter(name="home").exists()


def test_the_name_deletes_the_world_and_leaves_the_others(sample, other_world, root):
    answer = root.post("/w/home/delete/", {"name": "home"}, follow=True)
    assert levels(answer) == ["success"] and "home" in str(*answer.context["messages"])
    assert [world.name for world in World.objects.all()] == ["laboratory"]


def test_not_even_its_admins_delete_a_world(sample, admin, client):
    client.force_login(admin)
    assert client.post("/w/home/delete/", {"name": "home"}).status_code == 403
    assert World.objects.filter(name="home").exists()


def test_django_s_admin_neither_deletes_nor_renames_a_world(world, root):
    assert root.get(reverse("admin:annotations_world_delete", args=[world.pk])).status_code == 403
    page = reverse("admin:annotations_world_change", args=[world.pk])
    forms = {
        "memberships-TOTAL_FORMS": 0,
        "memberships-INITIAL_FORMS": 0,
    }
    root.post(page, {"name": "renamed", "description": "New.", **forms})
    world.refresh_from_db()
    assert (world.name, world.description) == ("home", "New.")
