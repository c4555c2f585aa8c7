"""/api/v1/tokens/ and /api/v1/sessions/"""

from __future__ import annotations

from datetime import timedelta

import pytest
from django.utils import timezone

from annotations.models import ApiToken, Scope
from annotations.web.people.token_forms import MOST_TOKENS


def test_a_token_is_made_used_and_revoked(call_as, admin, client):
    made = call_as(admin, "post", "tokens/", {"name": "robot", "scope": "annotate", "days": 5})
    assert (made.status_code, made["Cache-Control"]) == (201, "no-store")
    key = made.json()["key"]
    headers = {"authorization": f"Bearer {key}"}
    listed = client.get("/api/v1/tokens/", headers=headers)
    assert key not in listed.content.decode()
    (this,) = [row for row in listed.json()["results"] if row["is_this"]]
    assert (this["name"], this["scope"]) == ("robot", "annotate")
    address = f"tokens/{made.json()['id']}/"
    assert call_as(admin, "delete", address, if_match="*").status_code == 204
    assert client.get("/api/v1/tokens/", headers=headers).status_code == 401


@pytest.mark.parametrize(
    ("scope", "asked", "status"),
    [
        ("read", "read", 403),
        ("annotate", "read", 201),
        ("annotate", "annotate", 201),
        ("annotate", "train", 403),
        ("train", "admin", 403),
        ("admin", "admin", 201),
    ],
)
def test_a_token_makes_none_that_may_do_more(scope, asked, status, call_as, admin):
    sent = {"name": "robot", "scope": asked}
    assert call_as(admin, "post", "tokens/", sent, scope=Scope(scope)).status_code == status


def test_a_token_makes_none_that_outlives_it(admin, client):
    token, key = ApiToken.issue(admin, "short", days=2)
    sent, headers = {"name": "long", "days": 300}, {"authorization": f"Bearer {key}"}
    client.post("/api/v1/tokens/", sent, content_type="application/json", headers=headers)
    assert ApiToken.objects.get(name="long").expires_at == token.expires_at


def test_who_is_logged_in_makes_any_token(adam):
    sent = {"name": "long", "scope": "admin", "days": 300}
    made = adam.post("/api/v1/tokens/", sent, content_type="application/json")
    assert made.status_code == 201
    lives = ApiToken.objects.get(name="long").expires_at - timezone.now()
    assert lives > timedelta(days=299)


def test_a_weaker_token_revokes_no_stronger_one(call_as, admin):
    strong, _ = ApiToken.issue(admin, "strong", scope=Scope.TRAIN)
    address = f"tokens/{strong.pk}/"
    weak = call_as(admin, "delete", address, scope=Scope.ANNOTATE, if_match="*")
    assert (weak.status_code, ApiToken.objects.filter(pk=strong.pk).count()) == (403, 1)
    same = call_as(admin, "delete", address, scope=Scope.TRAIN, if_match="*")
    assert same.status_code == 204


def test_tokens_of_others_are_nobodys_business(call_as, admin, annotator):
    theirs, _ = ApiToken.issue(annotator, "theirs")
    assert call_as(admin, "delete", f"tokens/{theirs.pk}/", if_match="*").status_code == 404
    assert call_as(admin, "get", f"tokens/{theirs.pk}/").status_code == 404


def test_there_are_not_too_many(call_as, admin):
    row = ApiToken.issue(admin, "one")[0]
    rows = [
        ApiToken(user=admin, name="x", scope="read", digest=str(number), expires_at=row.expires_at)
        for number in range(MOST_TOKENS)
    ]
    ApiToken.objects.bulk_create(rows)
    assert call_as(admin, "post", "tokens/", {"name": "one more"}).status_code == 400


def test_one_logs_oneself_out_elsewhere(call_as, admin, adam):
    (row,) = call_as(admin, "get", "sessions/").json()["results"]
    assert adam.cookies["sessionid"].value not in str(row)
    address = f"sessions/{row['id']}/"
    assert call_as(admin, "delete", address, if_match="*", scope=Scope.TRAIN).status_code == 403
    assert call_as(admin, "delete", address, if_match="*").status_code == 204
    assert call_as(admin, "get", address).status_code == 404
    assert adam.get("/account/").status_code == 302


def test_one_logs_oneself_out_everywhere(admin, adam, call_as):
    assert adam.post("/api/v1/sessions/end/").status_code == 204
    assert adam.get("/account/").status_code == 302
    assert call_as(admin, "get", "sessions/").json()["results"] == []
