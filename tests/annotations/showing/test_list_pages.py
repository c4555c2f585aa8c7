"""The lists of a world: what they show, filter, sort, and what a page of them costs."""

from __future__ import annotations

import pytest

from annotations.exchange.generator_import import import_generator
from annotations.models import (
    Command,
    Entity,
    Grammar,
    LogicalForm,
    Production,
    SemanticTemplate,
    StoredProblem,
)
from tests.annotations.conftest import TINY, as_bytes
from tests.sample_world import make_paraphrase

LISTS = ["ontology", "grammar", "templates", "commands", "forms", "paraphrases", "predicates"]
# A page of a list never costs more: session, user, world, roles, worlds, rail, worker and runs (3),
# the filters' choices, rows, count, problems.
MOST_QUERIES = 17


def texts(page, field="anonymized_text"):
    return [getattr(row, field) for row in page.context["listing"].rows]


def many_commands(world, count):
    form = world.logical_forms.first()
    first = world.commands.count()
    Command.objects.bulk_create(
        Command(
            world=world,
            logical_form=form,
            anonymized_text=f"go to room {number}",
            length=4,
            task_category="1",
            position=first + number,
        )
        for number in range(count)
    )


@pytest.mark.parametrize("path", LISTS)
def test_an_empty_list_says_what_would_be_there(path, world, anna):
    page = anna.get(f"/w/home/{path}/").content.decode()
    assert 'class="empty"' in page


@pytest.mark.parametrize("path", LISTS)
def test_no_list_costs_a_query_a_row(path, sample, anna, django_assert_max_num_queries):
    many_commands(sample.world, 40)
    LogicalForm.objects.bulk_create(
        LogicalForm(world=sample.world, text=f"( go {n} )", head_predicate="go", depth=1, length=4)
        for n in range(40)
    )
    with django_assert_max_num_queries(MOST_QUERIES):
        assert anna.get(f"/w/home/{path}/").status_code == 200


def test_commands_are_found_by_a_word(sample, anna):
    page = anna.get("/w/home/commands/", {"q": "LOCATE"})
    assert texts(page) == ["locate the <object>"]
    assert [(chip.label, chip.value) for chip in page.context["listing"].chips] == [
        ("Search", "LOCATE")
    ]


def test_commands_are_filtered_by_their_head_predicate(sample, anna):
    assert texts(anna.get("/w/home/commands/", {"head": "go"})) == ["go to the <room>"]


def test_commands_are_filtered_by_a_predicate_anywhere(sample, anna):
    assert len(texts(anna.get("/w/home/commands/", {"mentions": "is_a"}))) == 2


def test_commands_are_filtered_by_their_template(sample, anna):
    chosen = sample.world.commands.exclude(template=sample.template)
    page = anna.get("/w/home/commands/", {"template": chosen.first().template_id})
    assert texts(page) == ["go to the <room>"]


def test_commands_are_sorted_by_the_url(sample, anna):
    shown = texts(anna.get("/w/home/commands/", {"sort": "-command"}))
    assert shown == sorted(shown, reverse=True)


def test_an_unknown_order_is_the_usual_one(sample, anna):
    page = anna.get("/w/home/commands/", {"sort": "password"})
    assert [row.position for row in page.context["listing"].rows] == [0, 1, 2]


def test_a_value_that_no_filter_offers_is_told_and_left_out(sample, anna):
    page = anna.get("/w/home/commands/", {"head": "nothing", "q": "go"})
    assert texts(page) == ["go to the <room>"]
    assert page.context["listing"].has_unknown_filters


def test_a_long_list_is_paged_and_keeps_its_filters(sample, anna):
    many_commands(sample.world, 70)
    first = anna.get("/w/home/commands/", {"q": "go to", "sort": "command"}).context["listing"]
    assert (len(first.rows), first.total) == (50, 71)
    assert first.previous_url == ""
    second = anna.get(f"/w/home/commands/{first.next_url}").context["listing"]
    assert len(second.rows) == 21
    assert second.form.cleaned_data["q"] == "go to"
    assert anna.get(f"/w/home/commands/{second.previous_url}").context["listing"].rows == first.rows


def test_dropping_a_filter_goes_back_to_the_first_page(sample, anna):
    page = anna.get("/w/home/commands/", {"q": "go", "sort": "command", "after": '["go",1]'})
    (chip,) = page.context["listing"].chips
    assert chip.remove_url == "?sort=command"


def test_text_of_any_origin_is_escaped(sample, anna):
    evil = sample.world.commands.first()
    evil.anonymized_text = "<script>alert(1)</script> the <object>"
    evil.save()
    Entity.objects.filter(text="tea").update(text='<img src=x onerror="alert(1)">')
    make_paraphrase(
        sample.world,
        prompt="go",
        utterance="<b>go</b>",
        grounded_form="<i>( go )</i>",
        logical_form="( go )",
    )
    for path in ("commands", "ontology", "paraphrases"):
        page = anna.get(f"/w/home/{path}/").content.decode()
        assert "<script>alert" not in page and "<img" not in page and "<b>go" not in page
        assert "<i>( go" not in page


def test_entities_are_counted_by_class(sample, anna):
    classes = anna.get("/w/home/ontology/").context["classes"]
    assert classes == {"object": 2, "category": 1, "location": 2, "room": 2}


def test_problems_stand_on_the_page_that_they_are_about(sample, anna):
    StoredProblem.objects.create(
        world=sample.world,
        subject="ontology",
        source="objects.xml",
        line=3,
        column=5,
        severity="warning",
        message="no such place",
        hint="name another",
    )
    page = anna.get("/w/home/ontology/").content.decode()
    assert page.count('<li class="problem problem--warning">') == 1
    assert "objects.xml:3:5" in page and "no such place" in page and "name another" in page


def warn(template, message):
    template.problems = [{"severity": "warning", "message": message}]
    template.save()


def test_a_problem_stands_in_the_row_of_its_template(sample, anna):
    warn(sample.template, "matches nothing")
    page = anna.get("/w/home/templates/").content.decode()
    assert "matches nothing" in page


def test_templates_are_filtered_by_their_problems(sample, anna):
    warn(sample.template, "matches nothing")
    with_problems = anna.get("/w/home/templates/", {"problems": "yes"}).context["listing"]
    without = anna.get("/w/home/templates/", {"problems": "no"}).context["listing"]
    assert list(with_problems.rows) == [sample.template]
    assert len(without.rows) == 1 and sample.template not in without.rows


def test_a_problem_of_a_file_stands_above_the_rows_once(sample, anna):
    for line in (sample.template.line, 99):
        StoredProblem.objects.create(
            world=sample.world,
            subject="templates",
            source=sample.template.source,
            line=line,
            severity="warning",
            message=f"about line {line}",
        )
    shown = anna.get("/w/home/templates/").context["problems"]
    assert [each.message for each in shown] == ["about line 99"]


@pytest.mark.parametrize(
    ("path", "model"), [("templates", SemanticTemplate), ("grammar", Production)]
)
def test_files_of_other_worlds_are_no_choice(path, model, sample, other_world, anna):
    import_generator(other_world.name, as_bytes({**TINY, "secret_rules.txt": "$x = y\n"}))
    theirs = Grammar.objects.get(world=other_world)
    model.objects.filter(grammar=theirs).update(source="secret_rules.txt")
    page = anna.get(f"/w/home/{path}/")
    assert "secret_rules" not in page.content.decode()
    mine = set(model.objects.filter(grammar__world=sample.world).values_list("source", flat=True))
    assert {
        name for name, _ in page.context["listing"].form.fields["source"].choices if name
    } == mine


def test_productions_are_filtered_by_the_category_that_uses_them(sample, anna):
    shown = anna.get("/w/home/grammar/", {"task_category": "1"}).context["listing"].rows
    assert {row.source for row in shown} == {"common_rules.txt", "tiny_category_1_grammar.txt"}


def test_a_list_without_its_frame_goes_to_htmx(sample, anna):
    whole = anna.get("/w/home/commands/")
    part = anna.get("/w/home/commands/", headers={"HX-Request": "true"})
    assert "HX-Request" in whole["Vary"] and "HX-Request" in part["Vary"]
    assert 'class="rail"' in whole.content.decode()
    assert 'class="rail"' not in part.content.decode()
    assert 'id="list"' in part.content.decode()


def test_complexity_counts_what_is_there(sample, anna):
    *_, all_of_them = anna.get("/w/home/commands/complexity/").context["columns"]
    assert (all_of_them.templates, all_of_them.commands, all_of_them.forms) == (2, 3, 2)
    assert all_of_them.commands_per_form == 1.5


def test_coverage_compares_the_grammar_with_what_templates_make(sample, anna):
    Command.objects.filter(anonymized_text="go to the <room>").delete()
    (category,) = anna.get("/w/home/grammar/coverage/").context["categories"]
    assert (category.size, category.commands, category.covered) == (3, 3, 2)
    assert category.n_uncovered == 1


def test_a_form_shows_its_commands_and_how_people_say_them(sample, anna):
    make_paraphrase(
        sample.world,
        prompt="go to the kitchen",
        utterance="off you go",
        grounded_form=sample.form.text,
        logical_form=sample.form.text,
    )
    page = anna.get(f"/w/home/forms/{sample.form.pk}/")
    assert len(texts(page)) == 2
    assert "off you go" in page.content.decode()
    assert "find the object" in page.content.decode()
