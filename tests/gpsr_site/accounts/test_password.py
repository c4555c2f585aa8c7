"""Everybody who is logged in changes their own password."""

from __future__ import annotations

from django.test import Client

from tests.conftest import client_of
from tests.notices import levels

NEW = "a battery staple"
TYPED = {"old_password": "correct horse", "new_password1": NEW, "new_password2": NEW}


def test_the_menu_leads_to_the_page(anna):
    assert 'href="/account/"' in anna.get("/").content.decode()
    assert 'href="/password/"' in anna.get("/account/").content.decode()
    assert 'name="old_password"' in anna.get("/password/").content.decode()


def test_the_new_password_counts_and_other_browsers_are_logged_out(anna, annotator):
    elsewhere = client_of(annotator)
    page = anna.post("/password/", TYPED, follow=True)
    assert levels(page) == ["success"]
    assert elsewhere.get("/").status_code == 302
    for password, status in (("correct horse", 200), (NEW, 302)):
        sent = {"username": annotator.username, "password": password}
        assert Client().post("/login/", sent).status_code == status


def test_a_wrong_old_password_changes_nothing(anna, annotator):
    answer = anna.post("/password/", {**TYPED, "old_password": "guess"})
    assert answer.context["form"].errors["old_password"]
    annotator.refresh_from_db()
    assert annotator.check_password("correct horse")


def test_a_password_that_is_easily_guessed_is_refused(anna):
    weak = {**TYPED, "new_password1": "password", "new_password2": "password"}
    assert anna.post("/password/", weak).context["form"].errors["new_password2"]
