"""Comments are edited and deleted by who wrote them, and both can be undone."""

from __future__ import annotations

import pytest

from annotations.models import Comment, Notice
from tests.annotations.web.editing.test_comment_pages import address, page_of_template, unread


@pytest.fixture
def comment(sample, anna):
    anna.post(address(sample), {"text": "Is this right?"})
    return Comment.objects.get()


def edit(client, comment, text, version=1):
    values = {"text": text, "version": version}
    return client.post(f"/w/home/comments/{comment.pk}/", values)


def act(client, comment, action):
    return client.post(f"/w/home/comments/{comment.pk}/{action}/", follow=True).content.decode()


def test_an_edit_shows_and_keeps_what_was_written_before(sample, anna, adam, comment):
    assert "edited</a>" not in page_of_template(adam, sample)
    answer = edit(anna, comment, "Is this wrong?")
    assert answer.url == f"/w/home/templates/{sample.template.pk}/#comments"
    page = page_of_template(adam, sample)
    assert "Is this wrong?" in page and "edited</a>" in page and "Is this right?" not in page
    versions = adam.get(f"/w/home/comments/{comment.pk}/").context["versions"]
    assert [each.text for each in versions] == ["Is this wrong?", "Is this right?"]
    assert [text for mark, text in versions[0].pieces if mark != "same"] == ["wrong"]


def test_an_earlier_version_is_restored_as_a_new_one(anna, comment):
    edit(anna, comment, "Is this wrong?")
    edit(anna, comment, "Is this right?", version=2)
    comment.refresh_from_db()
    assert (comment.text, comment.version) == ("Is this right?", 3)
    assert [each.text for each in comment.earlier_texts.all()] == [
        "Is this right?",
        "Is this wrong?",
    ]


def test_an_edit_of_an_older_version_overwrites_nothing_unseen(anna, comment):
    edit(anna, comment, "second")
    answer = edit(anna, comment, "third")
    form, (newest, *_) = answer.context["form"], answer.context["versions"]
    assert (newest.text, form["text"].value()) == ("second", "third")
    assert form.errors and 'name="version" value="2"' in answer.content.decode()
    assert edit(anna, comment, "third", version=2).status_code == 302
    assert Comment.objects.get().text == "third"


def test_the_same_text_is_no_new_version(anna, comment):
    edit(anna, comment, "Is this right?")
    assert Comment.objects.get().version == 1


def test_a_mention_added_by_an_edit_reaches_the_inbox_once(anna, comment, admin):
    for version, text in enumerate(("@adam look", "look", "@adam look", "look", "@adam"), start=1):
        edit(anna, comment, text, version)
        assert unread(admin) == ([text] if "@" in text else [])
    Notice.objects.update(read_at=comment.created_at)
    edit(anna, comment, "no", version=6)
    edit(anna, comment, "@adam again", version=7)
    assert unread(admin) == []
    assert Notice.objects.count() == 1


def test_who_is_answered_stays_told_when_a_mention_goes(sample, anna, adam, annotator):
    anna.post(address(sample), {"text": "Hm."})
    adam.post(address(sample), {"text": f"@{annotator} yes"})
    answer = Comment.objects.last()
    edit(adam, answer, "yes")
    assert unread(annotator) == ["yes"]
    assert not Notice.objects.get().is_mention
    edit(adam, answer, f"yes @{annotator}", version=2)
    assert Notice.objects.get().is_mention


def test_a_deleted_comment_is_gone_for_all_but_who_deleted_it(sample, anna, adam, comment, admin):
    edit(anna, comment, "Is this right, @adam?")
    restoring = f"/w/home/comments/{comment.pk}/restore/"
    assert restoring in act(anna, comment, "delete")
    assert "Is this right?" not in page_of_template(adam, sample)
    assert restoring not in page_of_template(adam, sample)
    assert unread(admin) == []
    assert adam.get(f"/w/home/comments/{comment.pk}/").status_code == 404
    assert edit(anna, comment, "again", version=2).status_code == 404
    act(adam, comment, "restore")
    assert Comment.objects.get().is_deleted
    act(anna, comment, "restore")
    assert "Is this right" in page_of_template(adam, sample)
    assert unread(admin) == ["Is this right, @adam?"]


def test_what_an_admin_deletes_its_author_does_not_restore(sample, anna, adam, comment):
    act(adam, comment, "delete")
    restoring = f"/w/home/comments/{comment.pk}/restore/"
    assert restoring in page_of_template(adam, sample)
    assert restoring not in page_of_template(anna, sample)
    assert anna.post(restoring).status_code == 403
    act(adam, comment, "restore")
    assert "Is this right?" in page_of_template(anna, sample)


def test_who_has_deleted_what_they_said_is_not_answered(sample, anna, adam, comment, annotator):
    act(anna, comment, "delete")
    adam.post(address(sample), {"text": "It is."})
    assert unread(annotator) == []
