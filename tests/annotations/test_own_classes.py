"""A world with classes of its own: grounding, parsing of utterances, files, archives, pages and routes take them."""

from __future__ import annotations

from random import Random

import pytest

from annotations.exchange.generator_export import generator_files
from annotations.exchange.generator_import import import_generator
from annotations.exchange.world_import import import_world
from annotations.generation.class_uses import why_kept
from annotations.generation.generating import generate_pairs
from annotations.generation.production_check import ProductionEdit, check_production
from annotations.generation.template_check import check_template
from annotations.language.forms import (
    DEFAULT_CLASSES,
    EntityClass,
    SymbolReader,
    read_form,
    require_token,
)
from annotations.language.grounding import Anonymizer, deanonymize, ground, question_for
from annotations.language.texts.errors import LanguageError, Position
from annotations.language.world import gloss, read_ontology, read_signatures, write_ontology
from annotations.models import Command, Entity, LogicalForm, World
from annotations.rows.from_rows import classes_of, ontology_of, predicates_of
from tests.annotations.exchange.packing import members_of, pack, pack_members

POSE = EntityClass("pose", "pose", "poses", 20, "way to sit", is_closed=True)
GARMENT = EntityClass("garment", "garment", "garments", 250, "garment")
CLASSES = b"""<classes>
  <class token="pose" singular="pose" plural="poses" hue="20" said="way to sit" closed="true"/>
  <class token="garment" plural="garments" hue="250"/>
</classes>"""
ENTITIES = b"""<entities>
  <pose name="raising their left arm" aliases="left arm up;whoever's waving"/>
  <pose name="sitting"/>
  <garment name="t shirt" colour="blue"/>
</entities>"""
GRAMMAR = b"$Main = find the person $how in the {room}\n$how = {pose} | who wears a {garment 1}\n"
TEMPLATES = """find the person {pose} in the {room} = (find (λ$1:e (person $1) (pose $1 {pose}) (at $1 {room})))
find the person who wears a {garment 1} in the {room} = (find (λ$1:e (person $1) (wears $1 {garment 1}) (at $1 {room})))
""".encode()
FILES = {
    "classes.xml": CLASSES,
    "entities.xml": ENTITIES,
    "locations.xml": b'<rooms><room name="kitchen"/></rooms>',
    "own.txt": GRAMMAR,
    "own_semantics.txt": TEMPLATES,
}


@pytest.fixture
def own(world) -> World:
    """``world`` with poses and garments."""
    report = import_generator(world.name, FILES)
    assert not report.is_refused, report.problems
    return world


def test_files_declare_classes_and_their_entities():
    ontology, problems = read_ontology(FILES)
    assert problems == ()
    assert list(ontology.classes) == [*DEFAULT_CLASSES, POSE, GARMENT]
    assert ontology.texts_of("pose") == ("raising their left arm", "sitting")
    written = {name: text.encode() for name, text in write_ontology(ontology).items()}
    assert written.keys() == {"classes.xml", "entities.xml", "locations.xml"}
    assert read_ontology(written) == (ontology, ())


@pytest.mark.parametrize(
    ("name", "text", "line"),
    [
        ("classes.xml", '<classes>\n<class token="Pose"/></classes>', 2),
        ("classes.xml", '<classes>\n<class token="pose2"/></classes>', 2),
        ("classes.xml", '<classes>\n<class token="beacon"/></classes>', 2),
        ("classes.xml", '<classes>\n<class token="lambda"/></classes>', 2),
        ("classes.xml", '<classes>\n<class token="pose" hue="360"/></classes>', 2),
        ("classes.xml", '<classes>\n<class token="pose" hue="²"/></classes>', 2),
        ("classes.xml", '<classes>\n<class token="a"/><class token="a"/></classes>', 2),
        ("classes.xml", f'<classes>\n<class token="a" said="{"x" * 61}"/></classes>', 2),
        ("entities.xml", '<entities>\n<planet name="mars"/></entities>', 2),
        ("entities.xml", "<entities>\n<room/></entities>", 2),
    ],
)
def test_what_is_no_class_is_an_error_with_its_place(name, text, line):
    _, problems = read_ontology({name: text.encode()})
    errors = [each.position for each in problems if each.is_error]
    assert [(each.source, each.line) for each in errors] == [(name, line)]


def test_a_token_is_a_word_that_means_nothing_else():
    for token in ("pose", "hand_side", "object", "room"):
        require_token(token)
    for token in ("", "Pose", "pose1", "_pose", "pose_", "a b", "pron", "where", "x" * 21, "any"):
        with pytest.raises(LanguageError):
            require_token(token)


def test_an_import_stores_classes_once_and_keeps_what_people_changed(own, anna):
    assert list(classes_of(own)) == [*DEFAULT_CLASSES, POSE, GARMENT]
    row = own.entity_classes.get(token="garment")
    assert (
        anna.post(
            f"/w/home/ontology/classes/{row.pk}/",
            {
                "singular": "piece of clothing",
                "plural": "clothes",
                "said": "garment",
                "hue": 9,
                "version": 1,
            },
        ).status_code
        == 302
    )
    again = import_generator(own.name, FILES)
    assert again.changes.as_json() == {"added": 0, "changed": 0, "removed": 0, "moved": 0}
    row.refresh_from_db()
    assert (row.plural, row.hue, row.version) == ("clothes", 9, 2)


def test_files_without_classes_are_read_with_those_of_the_world(own):
    rest = {name: data for name, data in FILES.items() if name != "classes.xml"}
    assert not import_generator(own.name, rest).is_refused
    report = import_generator("another", rest)
    assert report.is_refused and not World.objects.filter(name="another").exists()
    files = {each.position.source for each in report.problems if each.is_error}
    assert files == {"entities.xml", "own.txt", "own_semantics.txt"}


def test_a_misspelt_class_is_an_error_at_its_place(own):
    category = own.grammar.task_categories.get()
    checked = check_template(own, category, "find the {psoe 1}", "(find {psoe 1})")
    places = [(each.position.source, each.position.column) for each in checked.problems]
    assert checked.has_errors and checked.template is None
    assert places == [("pattern", 11), ("form", 8)]
    assert all("{pose}" in each.hint for each in checked.problems)
    production = check_production(ProductionEdit(own, "own.txt", "how", "as {psoe}"))
    assert production.has_errors and production.problems[0].position.column == 5
    bad = {**FILES, "own.txt": GRAMMAR.replace(b"{pose}", b"{psoe}")}
    report = import_generator(own.name, bad)
    (error,) = (each for each in report.problems if each.is_error)
    assert (error.position.source, error.position.line, error.position.column) == ("own.txt", 2, 9)
    assert "{pose}" in error.hint


def test_commands_and_forms_have_tokens_of_the_class(own):
    generate_pairs(own)
    assert set(own.commands.values_list("anonymized_text", flat=True)) == {
        "find the person <pose> in the <room>",
        "find the person who wears a <garment> in the <room>",
    }
    kinds = {name: each.signatures[0].arguments[1:] for name, each in predicates_of(own).items()}
    assert kinds["pose"] == ("pose",) and kinds["wears"] == ("garment",)
    assert LogicalForm.objects.filter(world=own, text__contains="<pose>").exists()


def test_an_utterance_names_members_by_their_words_and_their_aliases(own):
    ontology = ontology_of(own)
    anonymizer = Anonymizer(ontology)
    said = {
        "find whoever's waving in the kitchen": "find <pose> in the <room>",
        "get the one with the left arm up": "get the one with the <pose>",
        "all t shirts": "all <garment>",
        "all sittings": "all sittings",  # members of a closed class have no plural
    }
    assert {text: anonymizer.anonymize(text).text for text in said} == said
    form = read_form('(find (λ$1:e (person $1) (pose $1 "<pose>")))')
    given = deanonymize(form, anonymizer.anonymize("find whoever's waving"), ontology)
    assert given.form == read_form('(find (λ$1:e (person $1) (pose $1 "raising their left arm")))')


def test_an_open_slot_is_asked_for_as_the_class_is_said(own):
    ontology, declared = ontology_of(own), predicates_of(own)
    form = read_form('(find (λ$1:e (person $1) (pose $1 "<pose>")))')
    assert "way to sit" in gloss(form, declared, ontology.classes)
    given = deanonymize(form, Anonymizer(ontology).anonymize("find them"), ontology)
    (slot,) = given.open_slots
    assert slot.entity_class == "pose"
    assert "way to sit" in question_for(slot, given.form, declared, classes=ontology.classes)


def test_wildcards_of_a_class_are_grounded(own):
    pattern = SymbolReader("find the {pose} in a {garment?}", Position()).whole_line()
    made = ground(pattern, read_form("(find {pose})"), ontology_of(own), Random(1))
    (pose,) = (entity.text for wildcard, entity in made.values if wildcard.kind == "pose")
    assert made.text == f"find the {pose} in a garment"
    assert made.form == read_form(f'(find "{pose}")')


def test_signatures_take_the_classes_of_the_world(own):
    classes = classes_of(own)
    assert read_signatures("(pose, garment?)", classes)
    with pytest.raises(LanguageError):
        read_signatures("(pose)")


def test_the_world_survives_a_round_trip_of_its_files_and_of_its_archive(own, db):
    files = {name: text.encode() for name, text in generator_files(own).items()}
    assert not import_generator("copy", files).is_refused
    members = members_of(pack(own))
    import_world("moved", pack_members(members))
    for name in ("copy", "moved"):
        other = World.objects.get(name=name)
        assert classes_of(other) == classes_of(own)
        assert ontology_of(other) == ontology_of(own)
    # Archives of earlier releases have no classes.
    members = members_of(pack(World.objects.create(name="old")))
    assert b"whattosay" in members["rows/entity_classes.jsonl"]


def test_a_class_in_use_is_not_deleted(own, anna, call_as, annotator):
    pose = own.entity_classes.get(token="pose")
    route = f"worlds/home/entity-classes/{pose.pk}/"
    refused = call_as(annotator, "delete", route, if_match='"1"')
    assert (refused.status_code, refused.json()["detail"]) == (409, why_kept(pose))
    page = f"/w/home/history/entity_class/{pose.pk}/delete/"
    assert why_kept(pose) in anna.get(page).content.decode()
    answer = anna.post(page, {"version": 1}, follow=True)
    assert own.entity_classes.filter(token="pose").exists()
    assert why_kept(pose) in answer.content.decode()
    assert not why_kept(own.entity_classes.get(token="whattosay"))


def test_a_class_that_nothing_uses_is_deleted_and_brought_back(world, anna):
    sent = {
        "token": "colour",
        "singular": "colour",
        "plural": "colours",
        "said": "colour",
        "hue": 1,
    }
    assert anna.post("/w/home/ontology/classes/new/", sent).status_code == 302
    row = world.entity_classes.get(token="colour")
    assert anna.post("/w/home/ontology/classes/new/", sent).status_code == 200
    assert '<option value="colour"' in anna.get("/w/home/ontology/new/").content.decode()
    anna.post(f"/w/home/history/entity_class/{row.pk}/delete/", {"version": 1})
    assert not world.entity_classes.filter(token="colour").exists()
    entry = row.history.latest("history_id")
    anna.post(f"/w/home/history/entity_class/{row.pk}/", {"entry": entry.history_id})
    assert world.entity_classes.filter(token="colour").exists()


def test_the_style_sheet_of_a_world_colours_its_chips(own, anna):
    page = anna.get("/w/home/ontology/classes/")
    assert "/w/home/ontology/classes.css" in page.content.decode()
    answer = anna.get("/w/home/ontology/classes.css")
    assert answer["Content-Type"].startswith("text/css")
    assert '[data-class="pose"] { --angle: 20; }' in answer.content.decode()
    again = anna.get("/w/home/ontology/classes.css", headers={"if-none-match": answer["ETag"]})
    assert again.status_code == 304


def test_entities_of_a_class_are_added_by_page_and_route(own, anna, call_as, annotator):
    sent = {"entity_class": "pose", "text": "lying down", "aliases": ["on the floor"]}
    made = call_as(annotator, "post", "worlds/home/entities/", sent)
    assert made.status_code == 201
    refused = call_as(annotator, "post", "worlds/home/entities/", {**sent, "entity_class": "moon"})
    fields = [each["field"] for each in refused.json()["problems"]]
    assert (refused.status_code, fields) == (400, ["entity_class"])
    shown = anna.get("/w/home/ontology/?entity_class=pose")
    assert [row.entity_class for row in shown.context["listing"].rows] == ["pose"] * 3
    assert Entity.objects.filter(entity_class="pose").count() == 3
    assert Command.objects.count() == 0


def test_a_new_world_has_the_classes_that_every_world_has(db):
    world = World.objects.create(name="new")
    rows = [row.as_value for row in world.entity_classes.all()]
    assert rows == list(DEFAULT_CLASSES)
