"""Tokens: hashed, and no longer valid than the password of their owner."""

from __future__ import annotations

import pytest
from django.contrib.auth.hashers import make_password
from django.urls import reverse

from annotations.models import ApiToken, User


@pytest.fixture
def key(annotator) -> str:
    return ApiToken.issue(annotator, "notebook")[1]


def test_the_secret_is_not_stored(key):
    row = ApiToken.objects.values().get()
    assert all(key not in str(value) for value in row.values())


def test_a_new_password_ends_the_tokens(key, annotator):
    annotator.set_password("another horse")
    annotator.save()
    assert ApiToken.objects.for_key(key) is None


def test_a_new_password_by_the_admin_page_ends_them_too(key, annotator, superuser, client):
    client.force_login(superuser)
    page = reverse("admin:auth_user_password_change", args=[annotator.pk])
    new = {"password1": "a long new one 17", "password2": "a long new one 17"}
    assert client.post(page, {**new, "usable_password": "true"}).status_code == 302
    assert ApiToken.objects.for_key(key) is None


def test_other_changes_of_an_account_leave_them(key, annotator):
    annotator.first_name = "Anna"
    annotator.save()
    assert ApiToken.objects.for_key(key).user == annotator


def test_logging_in_with_an_older_hash_leaves_them(key, annotator, client, settings):
    settings.PASSWORD_HASHERS = [
        "django.contrib.auth.hashers.PBKDF2PasswordHasher",
        "django.contrib.auth.hashers.MD5PasswordHasher",
    ]
    old = make_password("correct horse", hasher="md5")
    User.objects.filter(pk=annotator.pk).update(password=old)
    client.post("/login/", {"username": "anna", "password": "correct horse"})
    annotator.refresh_from_db()
    assert annotator.password != old
    assert ApiToken.objects.for_key(key) is not None


def test_tokens_of_others_stay(key, reviewer, annotator):
    _, other = ApiToken.issue(reviewer, "notebook")
    annotator.set_password("another horse")
    annotator.save()
    assert ApiToken.objects.for_key(other).user == reviewer
