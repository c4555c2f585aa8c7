"""Every row shows its versions, and what was changed or deleted can be restored."""

from __future__ import annotations

import pytest

from annotations.editing.edits import change, delete
from annotations.editing.row_versions import MOST_SHOWN, history_of_row
from annotations.labelling.collecting import collect
from annotations.models import Entity, Predicate, Production, SemanticTemplate
from annotations.rows.row_kinds import KINDS
from tests.gpsr_site.routes.sample_rows import task_category
from tests.notices import levels
from tests.sample_world import guidelines_in, own_class_in, paraphrase_in, unused_primitive_in


def address(row, kind="template"):
    return f"/w/home/history/{kind}/{row.pk}/"


def restore(client, row, version):
    entry = row.history.get(version=version, history_type__in="+~")
    return client.post(address(row), {"entry": entry.history_id}, follow=True)


def test_versions_say_who_changed_what(sample, anna, admin):
    row = sample.template
    change(row, {"pattern": "find a $object", "form": "(go {kobject})"}, admin, 1)
    answer = anna.get(address(row))
    versions = answer.context["history"].versions
    assert [(each.number, each.author) for each in versions] == [(2, admin), (1, None)]
    page = answer.content.decode()
    assert "<ins>a</ins>" in page and "<mark>" in page


def test_a_row_that_nobody_changed_says_so(sample, anna):
    answer = anna.get(address(sample.template))
    assert answer.context["history"].versions == ()
    assert '<div class="empty">' in answer.content.decode()


def test_an_earlier_version_is_restored(sample, anna, admin):
    row, before = sample.template, sample.template.pattern
    change(row, {"pattern": "find a $object"}, admin, 1)
    assert levels(restore(anna, row, 1)) == ["success"]
    row.refresh_from_db()
    assert (row.pattern, row.version, row.author.username) == (before, 3, "anna")


DELETABLE = [kind for kind in KINDS.values() if kind.is_deletable]
KEPT = [kind for kind in KINDS.values() if not kind.is_deletable]


@pytest.mark.parametrize("kind", DELETABLE, ids=lambda kind: kind.name)
def test_what_was_deleted_is_listed_and_restored(kind, sample, anna, admin):
    paraphrase_in(sample.world)
    collect(sample.world, ["find the tea"])
    own_class_in(sample.world)
    unused_primitive_in(sample.world)
    task_category(sample)
    row = kind.rows_of(sample.world).last()
    listed = f"/w/home/history/{kind.name}/deleted/"
    assert not anna.get(listed).context["entries"]
    assert listed in anna.get(f"/w/home/{LISTS[kind.name]}/").content.decode()
    deleted = anna.post(f"{address(row, kind.name)}delete/", {"version": 1}, follow=True)
    answer = anna.get(listed)
    ((entry, text),) = answer.context["entries"]
    assert text == str(row)
    assert f'value="{entry.history_id}"' in deleted.content.decode()  # Undo, in the message
    anna.post(address(row, kind.name), {"entry": entry.history_id})
    assert kind.rows_of(sample.world).get(pk=row.pk).version == 2
    assert not anna.get(listed).context["entries"]


LISTS = {
    "template": "templates",
    "production": "grammar",
    "entity": "ontology",
    "entity_class": "ontology/classes",
    "task_category": "grammar/categories",
    "predicate": "predicates",
    "paraphrase": "paraphrases",
    "utterance": "utterances",
    "guidelines": "guidelines",
    "recipe": "recipes",
    "primitive": "recipes",
}


@pytest.mark.parametrize("kind", KEPT, ids=lambda kind: kind.name)
def test_what_is_never_deleted_has_versions_alone(kind, sample, adam, admin):
    guidelines_in(sample.world)
    row = kind.rows_of(sample.world).get()
    page, delete_page = address(row, kind.name), f"{address(row, kind.name)}delete/"
    assert adam.get(f"/w/home/{LISTS[kind.name]}/").status_code == 200
    assert adam.get(delete_page).status_code == 404
    assert adam.post(delete_page, {"version": 1}).status_code == 404
    change(row, {"text": "other"}, admin, 1)
    assert adam.post(page, {"entry": row.history.get(version=1).history_id}).url == page
    restored = kind.rows_of(sample.world).get()
    assert (restored.pk, restored.version, restored.text) == (row.pk, 3, row.text)


def test_the_page_of_a_deleted_template_leads_to_its_history(sample, anna, admin):
    delete(sample.template, admin, 1)
    answer = anna.get(f"/w/home/templates/{sample.template.pk}/", follow=True)
    assert answer.redirect_chain[-1][0] == address(sample.template)
    assert not answer.context["is_there"]


def test_texts_are_escaped(sample, anna, admin):
    change(sample.template, {"pattern": "<script>1</script>"}, admin, 1)
    assert "<script>1" not in anna.get(address(sample.template)).content.decode()


def test_a_name_that_was_taken_is_said(sample, anna, admin):
    row = sample.world.predicates.first()
    delete(row, admin, 1)
    Predicate.objects.create(world=sample.world, name=row.name, kind=row.kind)
    entry = row.history.first().history_id
    answer = anna.post(address(row, "predicate"), {"entry": entry}, follow=True)
    assert levels(answer) == ["error"]
    assert sample.world.predicates.filter(name=row.name).count() == 1


def test_an_entry_of_another_row_is_refused(sample, anna, admin):
    first, second = SemanticTemplate.objects.all()
    change(second, {"pattern": "x"}, admin, 1)
    entry = second.history.first().history_id
    answer = anna.post(address(first), {"entry": entry}, follow=True)
    assert levels(answer) == ["error"]
    first.refresh_from_db()
    assert (first.version, first.pattern == "x") == (1, False)


def test_a_reviewer_reads_and_does_not_restore(sample, client, reviewer, admin):
    change(sample.template, {"pattern": "x"}, admin, 1)
    client.force_login(reviewer)
    assert 'name="entry"' not in client.get(address(sample.template)).content.decode()
    assert client.post(address(sample.template), {"entry": 1}).status_code == 403


def test_a_long_history_is_read_in_parts(sample, admin):
    row = sample.template
    for number in range(MOST_SHOWN + 5):
        row = change(row, {"pattern": f"x {number}"}, admin, row.version)
    kind = KINDS["template"]
    first = history_of_row(kind, sample.world, row.pk)
    second = history_of_row(kind, sample.world, row.pk, first.older)
    numbers = [each.number for part in (first, second) for each in part.versions]
    assert numbers == list(range(MOST_SHOWN + 6, 0, -1))
    assert second.older is None


def test_kinds_are_those_that_people_edit(sample):
    assert {Entity, Predicate, Production, SemanticTemplate} < {
        kind.model for kind in KINDS.values()
    }
    assert set(KINDS) == set(LISTS)
