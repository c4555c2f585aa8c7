"""/api/v1/worlds/<w>/utterances/"""

from __future__ import annotations

import pytest

from annotations.labelling.label_answers import label
from annotations.models import Utterance, Verdict

ALL = "worlds/home/utterances/"


@pytest.fixture
def call(call_as, annotator):
    """A function: the answer to a request of the annotator."""
    return lambda method, path="", data=None: call_as(annotator, method, ALL + path, data)


def test_texts_are_taken_in_and_come_back_with_their_form(call, tiny_world, annotator):
    sent = {"texts": ["find the tea", "find the tea", "hello"], "origin": "dialogue"}
    answer = call("post", data=sent)
    assert (answer.status_code, answer.json()) == (
        201,
        {"added": 2, "duplicates": ["find the tea"], "upload": tiny_world.uploads.get().pk},
    )
    row = Utterance.objects.get(text="find the tea")
    label(row, Verdict.FORM, '(go "<room>")', annotator, 1)
    (listed,) = call("get", "?status=labelled").json()["results"]
    assert listed["logical_form"] == '( go " <room> " )'
    assert listed["spans"] == [[9, 12, "object", "tea"]]
    assert call("get", f"{row.pk}/").json() == listed
    assert len(call("get").json()["results"]) == 2


@pytest.mark.parametrize("sent", [{}, {"texts": ["x" * 501]}, {"texts": "x"}, {"texts": ["a\0"]}])
def test_what_cannot_be_stored_is_refused(call, tiny_world, sent):
    assert call("post", data=sent).status_code == 400
    assert call("get", "?status=late").status_code == 400
    assert not Utterance.objects.exists()
