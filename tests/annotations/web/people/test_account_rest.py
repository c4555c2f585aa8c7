"""/api/v1/accounts/ and /api/v1/notices/"""

from __future__ import annotations

from annotations.editing.commenting import SUBJECTS, add_comment
from annotations.models import AuditEntry


def test_an_account_is_closed_and_opened_again(call_as, superuser, admin, adam):
    rows = call_as(superuser, "get", "accounts/?sort=name").json()["results"]
    assert [row["name"] for row in rows] == ["adam", "root"]
    assert rows[0]["roles"] == [{"world": "home", "role": "admin"}]
    address = f"accounts/{admin.pk}/"
    assert call_as(superuser, "patch", address, {"is_active": False}).status_code == 428
    closed = call_as(superuser, "patch", address, {"is_active": False}, if_match="*")
    assert closed.json()["is_active"] is False
    assert adam.get("/account/").status_code == 302
    assert call_as(admin, "get", "worlds/").status_code == 401
    call_as(superuser, "patch", address, {"is_active": True}, if_match="*")
    assert call_as(admin, "get", "worlds/").status_code == 200
    assert AuditEntry.objects.order_by("pk").first().subject == "adam: closed"
    own = f"accounts/{superuser.pk}/"
    mine = call_as(superuser, "patch", own, {"is_active": False}, if_match="*")
    assert mine.status_code == 409


def test_whoever_lost_a_password_gets_a_link(call_as, superuser, admin, client):
    answer = call_as(superuser, "post", f"accounts/{admin.pk}/link/")
    assert answer["Cache-Control"] == "no-store"
    page = client.get(answer.json()["link"], follow=True)
    assert page.context["validlink"]


def test_what_waits_for_somebody_is_read(call_as, tiny_world, annotator, admin):
    template = tiny_world.grammar.templates.first()
    for text in ("@adam look", "@adam again"):
        add_comment(tiny_world, SUBJECTS["template"], template, text, annotator)
    rows = call_as(admin, "get", "notices/").json()["results"]
    assert [row["comment"]["text"] for row in rows] == ["@adam again", "@adam look"]
    one = call_as(admin, "post", f"notices/{rows[0]['id']}/read/").json()
    assert one["read_at"]
    assert call_as(annotator, "post", f"notices/{rows[1]['id']}/read/").status_code == 404
    assert call_as(admin, "post", "notices/read/").json() == {"read": 1}
