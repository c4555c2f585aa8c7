"""Renaming changes everything that names a thing, in one transaction, and nothing else."""

from __future__ import annotations

import pytest

from annotations.editing.edits import Overtaken, add, change, delete, restore
from annotations.editing.world_rename import rename, touched_by
from annotations.generation.generating import generate_pairs
from annotations.generation.template_check import check_template
from annotations.labelling.audit_findings import store_findings
from annotations.labelling.label_decisions import decide
from annotations.language.texts.errors import LanguageError
from annotations.models import (
    Entity,
    FindingStatus,
    Paraphrase,
    Predicate,
    Production,
    Recipe,
    SemanticTemplate,
    TaskCategory,
    World,
)
from annotations.models.description import TemplateStatus
from annotations.rows.history import history_of
from tests.doubted_labels import doubt
from tests.sample_world import make_paraphrase

GROUNDED = '( find ( lambda $1 e ( is_a $1 " tea " ) ) )'
CLASSES = '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'


@pytest.fixture
def home(tiny_world):
    generate_pairs(tiny_world)
    make_paraphrase(
        tiny_world,
        prompt="find the tea",
        utterance="where is the tea",
        grounded_form=GROUNDED,
        logical_form=CLASSES,
    )
    return World.objects.get(pk=tiny_world.pk)


def nouns(touched):
    return {each.noun: len(each) for each in touched}


def commands_of(world):
    return sorted(world.commands.values_list("anonymized_text", "logical_form__text"))


def test_a_nonterminal_there_and_back_leaves_every_text_as_it_was(home, admin):
    texts = [str(row) for row in [*Production.objects.all(), *SemanticTemplate.objects.all()]]
    commands = commands_of(home)
    row = Production.objects.filter(nonterminal="vbfind").first()
    touched = rename(row, "vbfind", "verb", admin, 1)
    assert nouns(touched) == {"production": 2, "template": 1}
    assert SemanticTemplate.objects.filter(pattern="$verb the $object", version=2).exists()
    assert commands_of(home) == commands
    assert not World.objects.get(pk=home.pk).commands_are_stale
    rename(Production.objects.get(pk=row.pk), "verb", "vbfind", admin, 2)
    again = [str(row) for row in [*Production.objects.all(), *SemanticTemplate.objects.all()]]
    assert again == texts


def test_a_predicate_changes_in_templates_forms_and_paraphrases(home, admin):
    row = Predicate.objects.get(name="find")
    touched = rename(row, "find", "locate", admin, 1)
    assert nouns(touched) == {"predicate": 1, "template": 1, "paraphrase": 1}
    assert {form for _, form in commands_of(home)} == {
        CLASSES.replace("find", "locate"),
        '( go " <room> " )',
    }
    row = Paraphrase.objects.get()
    assert row.grounded_form == GROUNDED.replace("find", "locate")
    assert [entry.version for entry in history_of(Paraphrase).filter(id=row.pk)] == [2, 1]


def test_a_predicate_changes_in_what_an_audit_found_too(home, admin):
    row = home.paraphrases.get()
    store_findings(home, [doubt(row, CLASSES.replace("find", "bring"))])
    rename(Predicate.objects.get(name="find"), "find", "locate", admin, 1)
    finding = home.audit_findings.open().get()
    assert finding.form == CLASSES.replace("find", "locate")
    decide(finding, FindingStatus.KEPT, admin)
    touched = rename(Predicate.objects.get(name="locate"), "locate", "find", admin, 2)
    assert nouns(touched)["audit finding"] == nouns(touched)["audit decision"] == 1
    finding.refresh_from_db()
    assert finding.decided_form == finding.decision.form == CLASSES


def test_an_entity_changes_where_it_is_a_span(home, admin):
    row = Entity.objects.get(text="tea")
    touched = rename(row, "tea", "mint tea", admin, 1)
    assert nouns(touched) == {"entity": 1, "paraphrase": 1}
    said = Paraphrase.objects.get()
    assert (said.prompt, said.utterance) == ("find the mint tea", "where is the mint tea")
    assert said.grounded_form == GROUNDED.replace("tea", "mint tea")
    assert said.logical_form == CLASSES
    assert said.edit_distance == 8


def test_a_place_of_the_same_name_in_two_rooms_keeps_one_name_and_a_room_is_followed(home, admin):
    sink = Entity.objects.filter(text="sink").first()
    rename(sink, "sink", "basin", admin, 1)
    assert Entity.objects.filter(text="basin").count() == 2
    kitchen = Entity.objects.get(text="kitchen")
    rename(kitchen, "kitchen", "galley", admin, 1)
    rooms = {row.text: row.attributes.get("room") for row in Entity.objects.all()}
    assert rooms["drinks"] == "galley"
    assert not any(value == "kitchen" for value in rooms.values())


def test_an_alias_changes_in_what_people_say_alone(home, admin):
    row = Entity.objects.get(text="milk")
    change(row, {"aliases": ["white stuff"]}, admin, 1)
    Paraphrase.objects.update(utterance="where is the white stuff")
    rename(Entity.objects.get(text="milk"), "white stuff", "moo juice", admin, 2)
    assert Entity.objects.get(text="milk").aliases == ["moo juice"]
    assert Paraphrase.objects.get().utterance == "where is the moo juice"


@pytest.mark.parametrize(
    ("model", "name", "new", "named"),
    [
        (Production, "vbfind", "object", r"\$object"),
        (Production, "Main", "Start", r"\$Main"),
        (Production, "vbfind", "two words", "two words"),
        (Predicate, "find", "go", r"\bgo\b"),
        (Predicate, "find", "lambda", "lambda"),
        (Entity, "tea", "Milk", "object .* Milk"),
        (Entity, "tea", "<room>", "<"),
        (Entity, "tea", "tea", None),
    ],
)
def test_a_name_that_clashes_is_refused_with_what_clashes(home, admin, model, name, new, named):
    field = {Production: "nonterminal", Predicate: "name", Entity: "text"}[model]
    row = model.objects.filter(**{field: name}).first()
    for attempt in (lambda: touched_by(row, name, new), lambda: rename(row, name, new, admin, 1)):
        with pytest.raises(LanguageError, match=named):
            attempt()
    assert model.objects.get(pk=row.pk).version == 1


def test_what_the_checker_says_names_the_new_name_in_drafts_too(home, admin):
    category = TaskCategory.objects.get()
    for form, status in (
        ("(find $vbfind)", TemplateStatus.DRAFT),
        ("(find $vbfind)", TemplateStatus.READY),
    ):
        checked = check_template(home, category, "$vbfind it", form)
        values = {"form": form, "status": status, "problems": checked.stored_problems}
        add(SemanticTemplate.for_category(category, pattern="$vbfind it", **values), admin)
    rename(Predicate.objects.get(name="find"), "find", "seek", admin, 1)
    rename(Production.objects.filter(nonterminal="vbfind").first(), "vbfind", "verb", admin, 1)
    for row in SemanticTemplate.objects.filter(pattern="$verb it"):
        checked = check_template(home, category, row.pattern, row.form)
        texts = {(each["message"], each["hint"]) for each in row.problems}
        assert texts == {(each.message, each.hint) for each in checked.problems}
        assert any("seek" in hint for _, hint in texts)


def test_a_deleted_predicate_is_missed_in_drafts_and_restored_there(home, admin):
    row = SemanticTemplate.objects.get(form="(go {room})")
    change(row, {"status": TemplateStatus.DRAFT}, admin, 1)
    delete(Predicate.objects.get(name="go"), admin, 1)
    row.refresh_from_db()
    assert [each["message"] for each in row.problems] == ["there is no predicate go"]
    restore(history_of(Predicate).filter(name="go").first(), admin)
    row.refresh_from_db()
    assert row.problems == []


def test_nothing_changes_where_somebody_was_faster(home, admin):
    row = Predicate.objects.get(name="find")
    change(row, {"gloss": "seek {1}"}, admin, 1)
    with pytest.raises(Overtaken):
        rename(row, "find", "locate", admin, 1)
    assert SemanticTemplate.objects.filter(form__startswith="(find").exists()


def test_the_page_shows_what_changes_and_renames(home, anna, rene):
    row = Predicate.objects.get(name="find")
    address = f"/w/home/rename/predicate/{row.pk}/"
    page = anna.get(address, {"old": "find", "new": "locate", "version": 1}).content.decode()
    assert "<del>(find (λ$1:e (is_a $1 $object)))</del>" in page
    assert "3 rows change" in page
    assert anna.post(address, {"old": "find", "new": "go", "version": 1}).status_code == 200
    assert anna.post(address, {"old": "find", "new": "locate", "version": 7}).status_code == 409
    assert rene.post(address, {"old": "find", "new": "locate", "version": 1}).status_code == 403
    answer = anna.post(address, {"old": "find", "new": "locate", "version": 1}, follow=True)
    assert "Renamed in 1 predicate, 1 template, 1 paraphrase." in answer.content.decode()
    assert Predicate.objects.get(pk=row.pk).name == "locate"
    assert anna.get("/w/home/rename/template/1/").status_code == 404


def test_a_name_with_which_a_text_is_too_long_changes_nothing(world, annotator):
    primitive = world.primitives.get(name="say")
    calls = ", ".join([f'{primitive.name}("{number:03} {"x" * 25}")' for number in range(25)])
    columns = Recipe.columns_of(f"wave() -> {calls}")
    recipe = add(Recipe(world=world, position=99, **columns), annotator)
    with pytest.raises(LanguageError):
        rename(primitive, primitive.name, "say_aloud_" * 6, annotator, primitive.version)
    recipe.refresh_from_db()
    assert recipe.text == columns["text"]
