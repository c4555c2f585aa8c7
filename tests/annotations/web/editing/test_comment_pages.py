"""Comments on rows, mentions, and the inbox of those whom they concern."""

from __future__ import annotations

import pytest

from annotations.editing.commenting import SUBJECTS, add_comment, mentioned_in
from annotations.editing.edits import delete
from annotations.models import Comment, Membership, Notice, User, Utterance
from annotations.models.editing import MOST_CHARACTERS_OF_COMMENT
from tests.sample_world import guidelines_in, paraphrase_in


def address(sample):
    return f"/w/home/comments/template/{sample.template.pk}/"


def page_of_template(client, sample):
    return client.get(f"/w/home/templates/{sample.template.pk}/").content.decode()


def unread(user):
    return [notice.comment.text for notice in Notice.objects.of(user).unread()]


@pytest.fixture
def rows(sample):
    """A row of each subject."""
    paraphrase_in(sample.world)
    guidelines_in(sample.world)
    Utterance.objects.create(world=sample.world, text="go", anonymized_text="go")
    return {
        name: subject.model.objects.filter(**{subject.world_path: sample.world}).first()
        for name, subject in SUBJECTS.items()
    }


def test_a_comment_stands_on_the_page_and_waits_for_whom_it_names(sample, anna, adam, admin):
    answer = anna.post(address(sample), {"text": "Is this right, @Adam?"})
    assert answer.url == f"/w/home/templates/{sample.template.pk}/#comments"
    page = page_of_template(adam, sample)
    assert "<strong>@Adam</strong>" in page
    assert '<span class="unread">1</span>' in page
    inbox = adam.get("/inbox/")
    (notice,) = inbox.context["notices"]
    assert notice.is_mention and "Is this right" in inbox.content.decode()
    assert '<span class="unread">' not in anna.get("/inbox/").content.decode()


def test_who_commented_before_is_answered(sample, anna, adam, annotator, admin):
    anna.post(address(sample), {"text": "Hm."})
    adam.post(address(sample), {"text": "It is."})
    assert (unread(annotator), unread(admin)) == (["It is."], [])


def test_every_subject_takes_comments(rows, anna, sample):
    for name, row in rows.items():
        path = f"/w/home/comments/{name}/{row.pk}/"
        page = anna.post(path, {"text": f"On the {name}."}, follow=True).content.decode()
        assert f"On the {name}." in page, name
        assert anna.get(path).status_code == 200


def test_opening_a_notice_marks_it_read(sample, anna, adam, admin):
    anna.post(address(sample), {"text": "@adam"})
    notice = Notice.objects.get()
    answer = adam.post(f"/inbox/{notice.pk}/")
    assert answer.url == f"/w/home/templates/{sample.template.pk}/#comments"
    assert unread(admin) == []


def test_a_notice_about_what_was_deleted_leads_to_its_history(sample, anna, adam, admin):
    anna.post(address(sample), {"text": "@adam"})
    delete(sample.template, admin, 1)
    page = adam.post(f"/inbox/{Notice.objects.get().pk}/", follow=True)
    assert page.redirect_chain[-1][0].startswith(f"/w/home/history/template/{sample.template.pk}/")
    assert not page.context["is_there"] and 'name="entry"' in page.content.decode()


def test_all_can_be_marked_read(sample, anna, adam, admin):
    for text in ("@adam one", "@adam two"):
        anna.post(address(sample), {"text": text})
    assert len(unread(admin)) == 2
    adam.post("/inbox/")
    assert unread(admin) == []


def test_nobody_opens_the_notice_of_somebody_else(sample, anna, reviewer):
    anna.post(address(sample), {"text": f"@{reviewer}"})
    notice = Notice.objects.get()
    assert anna.post(f"/inbox/{notice.pk}/").status_code == 404
    assert unread(reviewer)


def test_who_leaves_a_world_sees_nothing_of_it(sample, anna, reviewer):
    anna.post(address(sample), {"text": f"@{reviewer}"})
    Membership.objects.filter(user=reviewer).delete()
    assert unread(reviewer) == []


def test_only_members_are_told(sample, anna, stranger):
    anna.post(address(sample), {"text": f"@{stranger} look"})
    assert not Notice.objects.exists()


def test_names_are_found_in_a_sentence():
    people = [User(pk=1, username="a.b"), User(pk=2, username="c")]
    assert mentioned_in("ask @A.B. or (@c)", people) == people
    assert mentioned_in("mail a@b.org", people) == []


def test_a_form_that_is_generated_anew_keeps_its_comments(sample, anna, annotator):
    subject, form = SUBJECTS["form"], sample.form
    comment = add_comment(sample.world, subject, form, "odd", annotator)
    type(form).objects.filter(pk=form.pk).update(text="( other )")
    form.pk = None
    form.save()
    assert subject.current_key(comment) == form.pk
    assert "odd" in anna.get(f"/w/home/forms/{form.pk}/").content.decode()


def test_texts_are_escaped_and_bounded(sample, anna):
    anna.post(address(sample), {"text": "<script>1</script> @<b>"})
    assert "<script>1" not in page_of_template(anna, sample)
    answer = anna.post(address(sample), {"text": "a" * (MOST_CHARACTERS_OF_COMMENT + 1)})
    assert answer.status_code == 200
    assert Comment.objects.count() == 1
