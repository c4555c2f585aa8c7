"""All accounts, for administrators of the site: closing, and a link for a new password."""

from __future__ import annotations

import pytest
from django.test import Client

from annotations.models import ApiToken, AuditEntry
from tests.conftest import client_of

NEW = {"new_password1": "a battery staple", "new_password2": "a battery staple"}


@pytest.fixture
def root(superuser) -> Client:
    return client_of(superuser)


def test_they_are_listed_with_their_roles(root, annotator, stranger):
    page = root.get("/accounts/").content.decode()
    assert "annotator of home" in page and "admin of laboratory" in page
    assert "stina" not in root.get("/accounts/?q=ann").content.decode()


def test_a_closed_account_is_out_at_once_and_can_be_opened(root, anna, annotator):
    _, key = ApiToken.issue(annotator, "robot")
    assert root.post(f"/accounts/{annotator.pk}/close/").url == "/accounts/"
    assert anna.get("/").status_code == 302
    assert ApiToken.objects.for_key(key) is None
    assert root.get("/accounts/?is_active=False").context["listing"].rows == [annotator]
    root.post(f"/accounts/{annotator.pk}/close/")
    assert ApiToken.objects.for_key(key) is not None


def test_nobody_closes_their_own(root, superuser):
    root.post(f"/accounts/{superuser.pk}/close/")
    superuser.refresh_from_db()
    assert superuser.is_active


def test_a_lost_password_is_set_by_a_link_once(root, annotator, anna):
    answer = root.post(f"/accounts/{annotator.pk}/link/", follow=True)
    assert answer.redirect_chain == [("/accounts/", 302)]
    link = answer.context["link"]
    assert "no-store" in answer["Cache-Control"]
    client = Client()
    form = client.get(link)
    assert client.post(form.url, NEW).url == "/login/"
    annotator.refresh_from_db()
    assert annotator.check_password(NEW["new_password1"])
    assert anna.get("/").status_code == 302  # logged out everywhere
    assert Client().get(link, follow=True).context["validlink"] is False
    assert link not in root.get("/accounts/").content.decode()
    written = str(list(AuditEntry.objects.values()))
    assert "make a link for a new password" in written and link.split("/")[-2] not in written


def test_a_password_that_is_easily_guessed_is_refused(root, annotator):
    client = Client()
    form = client.get(root.post(f"/accounts/{annotator.pk}/link/", follow=True).context["link"])
    weak = {"new_password1": "password", "new_password2": "password"}
    assert client.post(form.url, weak).context["form"].errors["new_password2"]


def test_a_closed_account_gets_no_link(root, annotator):
    root.post(f"/accounts/{annotator.pk}/close/")
    assert root.post(f"/accounts/{annotator.pk}/link/").status_code == 404
