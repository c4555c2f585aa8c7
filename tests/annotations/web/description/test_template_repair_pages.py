"""Templates that conflict, have no effect or leave the grammar, each with its repair."""

from __future__ import annotations

import pytest

from annotations.editing.edits import add
from annotations.models import Production, SemanticTemplate, TaskCategory, World
from tests.notices import levels

UNMATCHED, CONFLICTS, OUTSIDE = (
    f"/w/home/coverage/{name}/" for name in ("unmatched", "conflicts", "outside")
)


@pytest.fixture
def write(sample, annotator):
    """Add a ready template to the sample world."""
    category = sample.world.grammar.task_categories.get(name="1")

    def written(pattern: str, form: str) -> SemanticTemplate:
        unsaved = SemanticTemplate.for_category(
            category, pattern=pattern, form=form, status="ready"
        )
        return add(unsaved, annotator)

    return written


def repair(client, row: SemanticTemplate, **values):
    return client.post(
        f"/w/home/coverage/repair/{row.pk}/", {"version": row.version, **values}, follow=True
    )


def patterns_on(client, page: str) -> list[str]:
    return [row.pattern for row in client.get(page).context["listing"].rows]


@pytest.mark.parametrize("page", [UNMATCHED, CONFLICTS, OUTSIDE])
def test_a_clean_world_has_nothing_to_repair(page, sample, anna):
    assert '<div class="empty">' in anna.get(page).content.decode()


def test_a_template_outside_the_grammar_offers_the_nearest_pattern(write, anna):
    row = write("walk to the {room}", "(go {room})")
    assert patterns_on(anna, UNMATCHED) == patterns_on(anna, OUTSIDE) == [row.pattern]
    page = anna.get(f"/w/home/templates/{row.pk}/?nearest=1")
    assert page.context["nearest"][0].text == "go to the {room}"


def test_a_template_whose_commands_another_one_takes_has_no_effect(write, anna):
    write("go to the {room}", "(go {room})")
    assert patterns_on(anna, UNMATCHED) == ["go to the {room}"]
    assert patterns_on(anna, OUTSIDE) == []


def test_a_conflict_is_settled_with_the_form_of_one_of_the_two(write, sample, anna):
    later = write("go to the {room}", "(find {room})")
    (pair,) = anna.get(CONFLICTS).context["report"].pairs
    assert (pair.kept, pair.command, pair.count) == (later, "go to the <room>", 1)
    assert form_of(sample.world, "go to the <room>") == '( find " <room> " )'
    page = repair(anna, pair.kept, form_of=pair.lost.pk, list="conflicts")
    assert page.redirect_chain[-1][0] == CONFLICTS
    assert page.context["report"].pairs == ()
    assert form_of(sample.world, "go to the <room>") == '( go " <room> " )'


def test_a_conflict_is_settled_by_deletion_and_what_was_deleted_is_kept(write, sample, anna):
    later = write("go to the {room}", "(find {room})")
    repair(anna, later, list="conflicts")
    assert not SemanticTemplate.objects.filter(pk=later.pk).exists()
    assert form_of(sample.world, "go to the <room>") == '( go " <room> " )'
    assert later.pattern in anna.get("/w/home/history/template/deleted/").content.decode()


def test_a_form_moves_with_the_slots_of_the_other_pattern(write, sample, anna):
    later = write("$vbfind the {aobject}", "(find {aobject})")
    (pair,) = anna.get(CONFLICTS).context["report"].pairs
    assert pair.kept == later
    repair(anna, pair.kept, form_of=pair.lost.pk, list="conflicts")
    later.refresh_from_db()
    assert later.form == "(find (λ$1:e (is_a $1 {aobject})))"
    assert anna.get(CONFLICTS).context["report"].pairs == ()


def test_a_form_that_does_not_fit_is_refused(write, sample, anna):
    go = SemanticTemplate.objects.get(grammar__world=sample.world, pattern="go to the {room}")
    find = SemanticTemplate.objects.get(grammar__world=sample.world, pattern="$vbfind the $object")
    SemanticTemplate.objects.filter(pk=find.pk).update(form="(find $vbfind $object)")
    page = repair(anna, go, form_of=find.pk, list="conflicts")
    assert levels(page) == ["error"]
    go.refresh_from_db()
    assert go.form == "(go {room})"


def test_a_template_that_somebody_has_changed_is_left_alone(write, anna):
    row = write("walk to the {room}", "(go {room})")
    page = repair(anna, row, version=row.version + 1, list="unmatched")
    assert levels(page) == ["error"]
    assert patterns_on(anna, UNMATCHED) == [row.pattern]


@pytest.mark.parametrize("values", [{"version": "²"}, {"form_of": "x"}, {"list": "../x"}])
def test_odd_values_change_nothing(values, write, anna, sample):
    row = write("walk to the {room}", "(go {room})")
    answer = repair(anna, row, **{"version": 999, **values})
    assert answer.status_code in (200, 404)
    assert SemanticTemplate.objects.filter(pk=row.pk).exists()


def form_of(world: World, command: str) -> str:
    return world.commands.get(anonymized_text=command).logical_form.text


def test_a_duplicate_is_opened_deleted_or_moved_where_the_grammar_has_its_commands(
    write, sample, anna
):
    patterns = {"2": "go to the {room}", "3": "sing"}
    for name, expansion in patterns.items():
        Production.objects.create(
            grammar=sample.world.grammar,
            source=f"{name}.txt",
            nonterminal="Main",
            expansion=expansion,
            position=100 + int(name),
        )
        TaskCategory.objects.create(
            grammar=sample.world.grammar,
            name=name,
            position=int(name),
            rule_sources=[f"{name}.txt"],
            template_sources=[f"{name}_semantics.txt"],
        )
    assert anna.get(f"/w/home/templates/{sample.template.pk}/").context["duplicate"] is None
    row = write("go to the {room}", "(go {room})")
    page = anna.get(f"/w/home/templates/{row.pk}/")
    duplicate = page.context["duplicate"]
    assert (duplicate.other.form, [each.name for each in duplicate.moves]) == ("(go {room})", ["2"])
    assert f'href="/w/home/templates/{duplicate.other.pk}/"' in page.content.decode()
    repair(anna, row, move_to=duplicate.moves[0].pk)
    row.refresh_from_db()
    assert (row.task_category, row.source, row.version) == ("2", "2_semantics.txt", 2)
    assert anna.get(f"/w/home/templates/{row.pk}/").context["duplicate"] is None
