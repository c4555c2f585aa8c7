"""The second of two people gets both versions and a merge; what was typed is never lost."""

from __future__ import annotations

import pytest

from annotations.editing.edits import change, delete
from annotations.models import SemanticTemplate


@pytest.fixture
def template(sample):
    return sample.template


def opened(row, **values):
    """What the form of ``row`` sends that was opened now, with ``values`` typed into it."""
    category = row.grammar.task_categories.get(name=row.task_category).pk
    kept = {"pattern": row.pattern, "form": row.form, "status": row.status, "version": row.version}
    return {**kept, "task_category": category, **values}


def address(row):
    return f"/w/home/templates/{row.pk}/"


def send_form_of(client, row, answer, **values):
    """Send the form of the merge page as it is shown, with ``values`` typed into it."""
    form = answer.context["form"]
    data = {field.name: field.value() or "" for field in form if not field.field.disabled}
    extra = {} if answer.context["clash"].current else {"bring_back": "yes"}
    return client.post(address(row), {**data, **extra, **values})


def test_changes_of_different_fields_are_merged(template, anna, annotator, admin):
    mine = opened(template, status="disputed")
    change(template, {"pattern": "find a $object"}, admin, 1)
    answer = anna.post(address(template), mine)
    assert answer.status_code == 409
    assert not any(merged.is_clash for _, merged, _ in answer.context["changed"])
    assert send_form_of(anna, template, answer).status_code == 302
    row = SemanticTemplate.objects.get(pk=template.pk)
    assert (row.pattern, row.status, row.version) == ("find a $object", "disputed", 3)


def test_a_clash_shows_what_it_was_theirs_and_mine(template, anna, admin):
    mine = opened(template, pattern="find <b>my</b> $object", status="draft")
    before = template.pattern
    change(template, {"pattern": "find a $object"}, admin, 1)
    answer = anna.post(address(template), mine)
    ((field, merged, sides), *_) = answer.context["changed"]
    assert (field.name, merged.is_clash) == ("pattern", True)
    assert [side.value for side in sides] == [before, "find a $object", "find <b>my</b> $object"]
    assert field.value() == "find <b>my</b> $object"
    assert "<b>my</b>" not in answer.content.decode()
    assert "adam" in sides[1].title and sides[1].title in answer.content.decode()


def test_who_was_faster_in_another_tab_is_not_told_of_a_third_person(template, anna, annotator):
    mine = opened(template, pattern="find my $object")
    change(template, {"pattern": "find a $object"}, annotator, 1)
    page = anna.post(address(template), mine).content.decode()
    assert "You saved version 2 in another tab." in page and "anna has saved" not in page


def test_a_third_save_meanwhile_is_a_merge_again(template, anna, admin):
    mine = opened(template, pattern="find my $object")
    row = change(template, {"pattern": "find a $object"}, admin, 1)
    answer = anna.post(address(template), mine)
    change(row, {"pattern": "find one $object"}, admin, 2)
    again = send_form_of(anna, template, answer)
    assert again.status_code == 409
    assert send_form_of(anna, template, again, pattern="find my $object").status_code == 302


def test_what_somebody_deleted_meanwhile_comes_back_with_my_text(template, anna, admin):
    mine = opened(template, pattern="find my $object")
    delete(template, admin, 1)
    answer = anna.post(address(template), mine)
    assert answer.status_code == 409
    clash = answer.context["clash"]
    assert (clash.current, clash.last.history_user) == (None, admin)
    assert str(clash) in answer.content.decode()
    assert not SemanticTemplate.objects.filter(pk=template.pk).exists()
    assert send_form_of(anna, template, answer).status_code == 302
    assert SemanticTemplate.objects.get(pk=template.pk).pattern == "find my $object"


def test_a_row_that_never_was_is_not_found(template, anna):
    data = opened(template)
    template.pk = 10**6
    assert anna.post(address(template), data).status_code == 404
