"""/api/v1/worlds/<w>/comments/"""

from __future__ import annotations

import pytest

from annotations.models import Notice
from annotations.people.rate_limits import Rate

HOME = "worlds/home/"


@pytest.fixture
def call(call_as):
    """A function: the answer to a request of somebody about the world."""
    return lambda by, method, path, data=None, **headers: call_as(
        by, method, HOME + path, data, **headers
    )


@pytest.fixture
def path(tiny_world):
    return f"comments/template/{tiny_world.grammar.templates.first().pk}/"


def test_a_comment_is_written_edited_deleted_and_restored(call, path, annotator, reviewer):
    made = call(annotator, "post", path, {"text": "@rene is this right?"})
    assert made.status_code == 201, made.json()
    assert Notice.objects.get().user == reviewer
    own = f"comments/{made.json()['id']}/"
    assert call(reviewer, "get", path).json()["results"] == [made.json()]
    assert call(reviewer, "patch", own, {"text": "x"}, if_match="*").status_code == 403
    edited = call(annotator, "patch", own, {"text": "No."}, if_match=made["ETag"])
    assert (edited.json()["text"], edited.json()["version"]) == ("No.", 2)
    late = call(annotator, "patch", own, {"text": "Yes."}, if_match=made["ETag"])
    assert (late.status_code, late.json()["current"]["text"]) == (412, "No.")
    assert call(reviewer, "delete", own, if_match="*").status_code == 403
    assert call(annotator, "delete", own, if_match=edited["ETag"]).status_code == 204
    assert call(annotator, "get", path).json()["results"] == []
    assert call(reviewer, "post", f"{own}restore/").status_code == 403
    assert call(annotator, "post", f"{own}restore/").json()["text"] == "No."


def test_many_at_once_are_refused(call, path, annotator, monkeypatch):
    monkeypatch.setattr("annotations.web.editing.comment_rest.COMMENTS", Rate("few", 0, 60))
    assert call(annotator, "post", path, {"text": "Hm."}).status_code == 429
    assert call(annotator, "get", "comments/moon/1/").status_code == 404
