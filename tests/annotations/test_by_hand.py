"""A world from nothing: it has no classes, and its first production makes the grammar and a task category."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from annotations.exchange.generator_export import generator_files
from annotations.exchange.generator_import import import_generator
from annotations.exchange.world_import import import_world
from annotations.generation.generating import generate_pairs
from annotations.language.forms import DEFAULT_CLASSES
from annotations.models import Production, SemanticTemplate, TaskCategory, World
from annotations.rows.from_rows import classes_of
from tests.annotations.exchange.packing import members_of, pack, pack_members

GUIDE = Path(__file__).parents[2] / "docs" / "guides" / "by-hand.md"
FILES = (
    *("greenhouse_grammar.txt", "greenhouse_semantics.txt"),
    *("classes.xml", "entities.xml", "predicates.json"),
)
MAIN = {"nonterminal": "Main", "expansion": "go to the {room}"}
GO = {"pattern": "go to the {room}", "form": "(go {room})"}


@pytest.fixture
def annotate(call_as, annotator):
    """Send something to a route of the world ``home`` as an annotator."""

    def send(method, route, data=None, **headers):
        return call_as(annotator, method, f"worlds/home/{route}", data, **headers)

    return send


def names(world: World) -> list[str]:
    return list(TaskCategory.objects.filter(grammar__world=world).values_list("name", flat=True))


def test_the_first_production_makes_the_grammar_over_rest(world, annotate):
    made = annotate("post", "productions/", MAIN)
    assert made.status_code == 201, made.content
    assert (made.json()["source"], made.json()["task_category"]) == (
        "general_grammar.txt",
        "general",
    )
    assert names(world) == ["general"]
    assert annotate("post", "templates/", GO).status_code == 201
    assert [row.anonymized_text for row in world.commands.all()] == ["go to the <room>"]
    (category,) = annotate("get", "task-categories/").json()["results"]
    assert category["template_sources"] == ["general_semantics.txt"]


@pytest.mark.parametrize(
    ("route", "sent", "named"),
    [
        ("productions/", MAIN, {"source": "greenhouse"}),
        ("templates/", GO, {"task_category": "greenhouse"}),
    ],
)
def test_the_first_row_may_name_the_task_category(world, annotate, route, sent, named):
    assert annotate("post", route, {**sent, **named}).status_code == 201
    assert names(world) == ["greenhouse"]


@pytest.mark.parametrize("name", ["../up", "a/b", "$x"])
def test_a_set_is_named_as_a_file_can_be(world, annotate, name):
    for route, sent in (
        ("productions/", {**MAIN, "source": name}),
        ("templates/", {**GO, "task_category": name}),
        ("task-categories/", {"name": name}),
        ("task-categories/", {"name": "fine", "rule_sources": [name]}),
        ("task-categories/", {"name": "fine", "template_sources": [name]}),
    ):
        assert annotate("post", route, sent).status_code == 400, (route, sent)
    assert names(world) == []


def test_the_first_production_and_template_on_the_pages(world, anna):
    page = anna.get("/w/home/grammar/new/")
    assert page.context["form"]["nonterminal"].value() == "Main"
    assert page.context["is_first"]
    once = page.context["form"]["once"].value()
    for _ in range(2):  # a second press makes nothing
        assert anna.post("/w/home/grammar/new/", {**MAIN, "once": once}).status_code == 302
    assert Production.objects.count() == 1
    sent = {**GO, "status": "ready"}
    assert anna.post("/w/home/templates/new/", sent).status_code == 302
    assert SemanticTemplate.objects.get().task_category == "general"
    assert names(world) == ["general"]
    assert not anna.get("/w/home/grammar/new/").context["form"]["nonterminal"].value()


def test_one_task_category_is_not_asked_for(tiny_world, anna, annotate):
    label = 'for="id_task_category"'
    assert label not in anna.get("/w/home/templates/new/").content.decode()
    annotate("post", "task-categories/", {"name": "plants"})
    assert label in anna.get("/w/home/templates/new/").content.decode()


def test_a_first_template_needs_no_production(world, anna):
    assert anna.post("/w/home/templates/new/", {**GO, "status": "ready"}).status_code == 302
    assert world.commands.get().anonymized_text == "go to the <room>"


def test_the_first_production_is_checked_like_any(world, anna, annotate):
    endless = {**MAIN, "expansion": "go $Main"}
    refused = annotate("post", "productions/", {**endless, "source": "greenhouse"})
    assert refused.status_code == 400
    shown = anna.post("/w/home/grammar/new/", endless)
    assert shown.context["form"].has_error("expansion")
    assert not TaskCategory.objects.exists()


def test_where_there_are_several_sets_one_is_named(tiny_world, annotate):
    annotate("post", "task-categories/", {"name": "plants"})
    line = {"nonterminal": "Main", "expansion": "water it"}
    for wrong in ({}, {"source": "nowhere"}):
        refused = annotate("post", "productions/", {**line, **wrong})
        (problem,) = refused.json()["problems"]
        assert (refused.status_code, problem["field"]) == (400, "source")
        assert "plants" in problem["message"]  # what there is
    stored = annotate("post", "productions/", {**line, "source": "plants"}).json()
    assert (stored["source"], stored["task_category"]) == ("plants_grammar.txt", "plants")
    template = {"pattern": "water it", "form": "(water it)"}
    refused = annotate("post", "templates/", template)
    (problem,) = refused.json()["problems"]
    assert (refused.status_code, problem["field"]) == (400, "task_category")


def test_a_category_shares_the_sets_of_another(tiny_world, annotate):
    sent = {"name": "slow", "rule_sources": ["common_rules.txt", "slow"]}
    made = annotate("post", "task-categories/", sent).json()
    assert made["rule_sources"] == ["common_rules.txt", "slow_grammar.txt"]
    line = {"nonterminal": "Main", "expansion": "slowly $vbfind it", "source": "slow"}
    assert annotate("post", "productions/", line).status_code == 201
    template = {"pattern": "slowly $vbfind it", "form": "(find it)", "task_category": "slow"}
    assert annotate("post", "templates/", template).status_code == 201
    texts = tiny_world.commands.filter(task_category="slow").values_list("anonymized_text")
    assert sorted(texts) == [("slowly find it",), ("slowly locate it",)]


def test_sets_that_lead_back_to_themselves_are_refused(tiny_world, annotate):
    annotate("post", "task-categories/", {"name": "plants"})
    line = {"nonterminal": "vbfind", "expansion": "$object", "source": "plants"}
    assert annotate("post", "productions/", line).status_code == 201
    line = {"nonterminal": "object", "expansion": "$vbfind", "source": "tiny_category_1"}
    assert annotate("post", "productions/", line).status_code == 201
    sent = {"name": "both", "rule_sources": ["plants", "tiny_category_1"]}
    assert annotate("post", "task-categories/", sent).status_code == 400


def test_categories_are_ordered_by_page_and_route(tiny_world, anna, annotate):
    for name in ("plants", "beds"):
        annotate("post", "task-categories/", {"name": name})
    first, plants, beds = TaskCategory.objects.all()
    anna.post("/w/home/grammar/categories/", {"up": beds.pk})
    assert names(tiny_world) == ["1", "beds", "plants"]
    sent = {"order": [plants.pk, first.pk, beds.pk]}
    answered = annotate("post", "task-categories/order/", sent)
    assert [each["name"] for each in answered.json()] == ["plants", "1", "beds"]
    assert names(tiny_world) == ["plants", "1", "beds"]
    clash = annotate("post", "task-categories/order/", {"order": [plants.pk, first.pk]})
    assert clash.status_code == 409


def test_the_first_category_has_the_commands_that_two_make(tiny_world, annotate):
    sent = {"name": "again", "rule_sources": ["common_rules.txt", "tiny_category_1", "again"]}
    sent |= {"template_sources": ["tiny_category_1_semantics.txt", "again"]}
    again = annotate("post", "task-categories/", sent).json()
    assert {row.task_category for row in tiny_world.commands.all()} == {"1"}
    first = TaskCategory.objects.get(name="1")
    annotate("post", "task-categories/order/", {"order": [again["id"], first.pk]})
    assert {row.task_category for row in tiny_world.commands.all()} == {"again"}


def test_a_renamed_category_keeps_its_rows_and_commands(world, anna, annotate):
    annotate("post", "productions/", MAIN)
    annotate("post", "templates/", GO)
    command = world.commands.get()
    row = TaskCategory.objects.get()
    page = f"/w/home/rename/task_category/{row.pk}/"
    answered = anna.post(page, {"old": "general", "new": "rooms", "version": row.version})
    assert answered.status_code == 302
    stored = TaskCategory.objects.get()
    assert (stored.name, stored.version) == ("rooms", row.version + 1)
    assert stored.rule_sources == ["rooms_grammar.txt"]
    for each in (Production.objects.get(), SemanticTemplate.objects.get()):
        assert each.task_category == "rooms"
        assert each.source in (*stored.rule_sources, *stored.template_sources)
    kept = world.commands.get()
    assert (kept.pk, kept.task_category) == (command.pk, "rooms")
    route = f"rename/task_category/{row.pk}/"
    refused = annotate("post", route, {"new": "a/b"}, if_match='"2"')
    assert refused.status_code == 400


def test_a_category_in_use_stays_and_an_empty_one_goes_and_comes_back(world, annotate, anna):
    annotate("post", "productions/", MAIN)
    used = TaskCategory.objects.get()
    route = f"task-categories/{used.pk}/"
    assert annotate("delete", route, if_match='"1"').status_code == 409
    assert anna.post(f"/w/home/history/task_category/{used.pk}/delete/", {"version": 1})
    assert names(world) == ["general"]
    made = annotate("post", "task-categories/", {"name": "plants"}).json()
    assert annotate("delete", f"task-categories/{made['id']}/", if_match='"1"').status_code == 204
    (entry,) = annotate("get", "deleted/task_category/").json()["results"]
    back = annotate("post", f"history/task_category/{made['id']}/", {"entry": entry["entry"]})
    assert back.status_code == 200
    assert names(world) == ["general", "plants"]


def test_a_download_of_a_world_by_hand_imports_as_the_same(world, annotate):
    annotate("post", "productions/", {**MAIN, "source": "green house"})
    annotate("post", "templates/", GO)
    shared = {"name": "slow", "rule_sources": ["green house", "slow"]}
    annotate("post", "task-categories/", shared)
    line = {"nonterminal": "Main", "expansion": "slowly", "source": "slow"}
    annotate("post", "productions/", line)
    files = {name: text.encode() for name, text in generator_files(world).items()}
    report = import_generator("copy", files)
    assert not report.is_refused
    copy = World.objects.get(name="copy")
    assert names(copy) == names(world) == ["green house", "slow"]
    for model in (Production, SemanticTemplate):
        rows = model.objects.filter(grammar__world=world).values_list("source", "task_category")
        copied = model.objects.filter(grammar__world=copy).values_list("source", "task_category")
        assert sorted(rows) == sorted(copied)


def test_an_import_keeps_what_people_made_of_the_categories(tiny_world, tiny, anna, annotate):
    annotate("post", "task-categories/", {"name": "plants"})
    first = TaskCategory.objects.get(name="1")
    page = f"/w/home/rename/task_category/{first.pk}/"
    anna.post(page, {"old": "1", "new": "rooms", "version": 1})
    assert not import_generator("home", tiny).is_refused
    assert names(tiny_world) == ["rooms", "plants"]
    assert {row.task_category for row in SemanticTemplate.objects.all()} == {"rooms"}
    assert TaskCategory.objects.get(name="rooms").commands_in_grammar == 3


@pytest.fixture
def bare(call_as, superuser) -> World:
    """The world ``green``, made as people make one that starts with nothing."""
    assert call_as(superuser, "post", "worlds/", {"name": "green"}).status_code == 201
    return World.objects.get(name="green")


@pytest.fixture
def plant(bare, call_as, superuser):
    """Send something to a route of the bare world as its admin."""

    def send(method, route, data=None, **headers):
        return call_as(superuser, method, f"worlds/green/{route}", data, **headers)

    return send


def test_a_greenhouse_is_described_from_nothing(bare, plant):
    for token in ("plant", "bed"):
        assert plant("post", "entity-classes/", {"token": token}).status_code == 201
    for token, names_of in {"plant": ["tomatoes"], "bed": ["bed one", "bed two"]}.items():
        for text in names_of:
            sent = {"entity_class": token, "text": text}
            assert plant("post", "entities/", sent).status_code == 201
    said = "water the {plant} in {bed}"
    sent = {"name": "water", "kind": "action", "signatures": [["plant", "bed"]]}
    assert plant("post", "predicates/", sent).status_code == 201
    production = {"nonterminal": "Main", "expansion": said}
    assert plant("post", "productions/", production).json()["problems"] == []
    template = {"pattern": said, "form": "(water {plant} {bed})"}
    assert plant("post", "templates/", template).json()["problems"] == []
    (command,) = plant("get", "commands/").json()["results"]
    assert command["anonymized_text"] == "water the <plant> in <bed>"
    assert command["is_in_grammar"]


def test_a_new_world_has_no_classes_and_imposes_none(bare, plant, client, superuser):
    assert plant("get", "entity-classes/").json()["results"] == []
    client.force_login(superuser)
    for page in ("ontology/new/", "ontology/paste/"):
        assert (
            'href="/w/green/ontology/classes/new/"'
            in client.get(f"/w/green/{page}").content.decode()
        )
    refused = plant("post", "entities/", {"entity_class": "object", "text": "cup"})
    (problem,) = refused.json()["problems"]
    assert (refused.status_code, problem["field"]) == (400, "entity_class")
    for wildcard in ("object", "kobject", "room", "name"):
        sent = {"nonterminal": "Main", "expansion": f"take the {{{wildcard}}}"}
        assert plant("post", "productions/", sent).status_code == 400
    sent = {"name": "take", "kind": "action", "signatures": [["object"]]}
    assert plant("post", "predicates/", sent).status_code == 400
    assert not TaskCategory.objects.exists()


def test_the_words_of_a_class_follow_from_its_token(bare, plant):
    made = plant("post", "entity-classes/", {"token": "plant_pot"}).json()
    words = [made[name] for name in ("singular", "plural", "said")]
    assert words == ["plant pot", "plant pots", "plant pot"]
    other = plant("post", "entity-classes/", {"token": "bed", "said": "plot"}).json()
    assert other["said"] == "plot"
    assert abs(made["hue"] - other["hue"]) == 180  # as unlike as can be


def test_the_classes_of_a_household_are_added_by_page_and_route(bare, plant, client, superuser):
    plant("post", "entity-classes/", {"token": "room", "singular": "glasshouse"})
    client.force_login(superuser)
    assert client.get("/w/green/ontology/classes/").context["missing"]
    client.post("/w/green/ontology/classes/household/")
    assert not client.get("/w/green/ontology/classes/").context["missing"]
    rows = plant("post", "entity-classes/household/").json()
    assert [each["token"] for each in rows][:2] == ["room", "object"]
    assert len(rows) == len(DEFAULT_CLASSES)
    assert rows[0]["singular"] == "glasshouse"
    gesture = next(each for each in rows if each["token"] == "gesture")
    route = f"entity-classes/{gesture['id']}/"
    assert plant("delete", route, if_match='"1"').status_code == 204
    assert "gesture" not in classes_of(bare)


def test_an_import_brings_its_classes_to_a_bare_world(bare, tiny):
    assert not import_generator("green", tiny).is_refused
    assert list(classes_of(bare)) == list(DEFAULT_CLASSES)


def test_files_without_things_of_a_household_bring_none_of_its_classes(bare, plant):
    plant("post", "entity-classes/", {"token": "plant"})
    plant("post", "entities/", {"entity_class": "plant", "text": "basil"})
    plant("post", "productions/", {"nonterminal": "Main", "expansion": "water the {plant}"})
    files = {name: text.encode() for name, text in generator_files(bare).items()}
    assert not import_generator("green", files).is_refused
    assert classes_of(bare).tokens == ("plant",)
    household = {**files, "names.xml": b"<names><name>Ada</name></names>"}
    assert not import_generator("green", household).is_refused
    assert set(classes_of(bare).tokens) == {"plant", *DEFAULT_CLASSES.tokens}


@pytest.mark.parametrize("tokens", [(), ("plant",)])
def test_an_archive_of_a_bare_world_is_bare(bare, plant, tokens):
    for token in tokens:
        plant("post", "entity-classes/", {"token": token})
    import_world("moved", pack_members(members_of(pack(bare))))
    assert classes_of(World.objects.get(name="moved")).tokens == tokens


def test_an_archive_that_uses_a_class_without_its_row_has_it(tiny_world):
    members = members_of(pack(tiny_world))
    manifest = json.loads(members["world.json"])
    assert manifest["rows"].pop("entity_classes") == len(DEFAULT_CLASSES)
    rows = members.pop("rows/entity_classes.jsonl").splitlines(keepends=True)
    name = next(line for line in rows if b'"name"' in line and b"gesture" not in line)
    manifest["rows"]["entity_classes"] = 1
    moved = {**members, "world.json": json.dumps(manifest).encode()}
    import_world("moved", pack_members({**moved, "rows/entity_classes.jsonl": name}))
    assert {"object", "category", "room", "location"} <= {
        *classes_of(World.objects.get(name="moved")).tokens
    }


def test_the_folder_of_the_guide_is_a_world(db, tmp_path):
    texts = re.findall(r"^```text\n(.*?)^```", GUIDE.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    for name, text in zip(FILES, texts, strict=True):
        (tmp_path / name).write_text(text, encoding="utf-8")
    report = import_generator("greenhouse", tmp_path)
    assert not report.problems
    world = World.objects.get(name="greenhouse")
    assert {each.token for each in classes_of(world)} == {"plant", "bed"}
    assert names(world) == ["greenhouse"]
    generate_pairs(world)
    assert {row.anonymized_text for row in world.commands.all()} == {
        *("water the <plant> in <bed>", "give some water to the <plant> in <bed>"),
        "go to <bed>",
    }


def test_the_next_row_begins_like_the_one_before_it(bare, client, superuser):
    client.force_login(superuser)
    new = "/w/green/ontology/classes/new/"
    assert client.post(new, {"token": "plant", "next": "yes"})["Location"].startswith(new)
    new = "/w/green/grammar/new/"
    sent = {"nonterminal": "water", "expansion": "water", "next": "yes"}
    again = client.post(new, sent)["Location"]
    shown = client.get(again).context["form"]
    assert again.startswith(new) and shown["nonterminal"].value() == "water"
    assert not shown["expansion"].value()
    assert "next" not in client.post(new, {**sent, "expansion": "irrigate"})["Location"]
