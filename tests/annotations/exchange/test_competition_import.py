"""The folder of a competition becomes entities of a world; everything else of it stays."""

from __future__ import annotations

import shutil

import pytest

from annotations.editing.edits import change, delete
from annotations.exchange.competition_import import import_competition
from annotations.exchange.generator_import import import_generator
from annotations.language.world.competition_folder import COMPETITION_FILES, LOCATIONS, NAMES
from annotations.models import Entity, World
from tests.annotations.commands.run_command import run


@pytest.fixture
def folder(shared_data):
    return shared_data / "competition-real" / "Incheon2026"


@pytest.fixture
def other(shared_data):
    return shared_data / "competition-real" / "PortugalOpen2026"


def entities(world="home", **chosen):
    rows = Entity.objects.filter(ontology__world__name=world, **chosen).order_by("position")
    return [(row.entity_class, row.text, row.aliases, row.attributes) for row in rows]


def test_a_folder_makes_a_world(db, folder):
    report = import_competition("c26", folder)
    assert report.entities == {"object": 30, "category": 8, "room": 4, "location": 20, "name": 10}
    assert len(entities("c26")) == 72
    assert len(report.without_room) == 20


def test_the_same_folder_twice_changes_nothing(world, folder):
    import_competition("home", folder)
    before = entities()
    assert import_competition("home", folder).changes.is_none
    assert entities() == before


def test_another_folder_replaces_entities_and_nothing_else(tiny_world, folder, other):
    tiny_world.ontology.entities.create(entity_class="whattosay", text="the time", position=99)
    grammar = list(tiny_world.grammar.productions.values())
    import_competition(tiny_world.name, folder)
    import_competition(tiny_world.name, other)
    assert entities(tiny_world.name, entity_class="whattosay") == [
        ("whattosay", "the time", [], {})
    ]
    assert list(tiny_world.grammar.productions.values()) == grammar
    alone = import_competition("alone", other)
    assert alone.changes.added == len(entities("alone"))
    mine = [each for each in entities(tiny_world.name) if each[0] in alone.entities]
    assert mine == entities("alone")


def test_rooms_of_locations_and_what_people_changed_stay(world, folder, admin):
    import_competition("home", folder)
    sofa = Entity.objects.get(text="sofa")
    room = {"attributes": {**sofa.attributes, "room": "living room"}}
    change(sofa, room, admin, sofa.version)
    coke = Entity.objects.get(text="coke")
    change(coke, {"aliases": ["cola"]}, admin, coke.version)
    milk = Entity.objects.get(text="milk")
    delete(milk, admin, milk.version)
    report = import_competition("home", folder)
    assert report.changes.is_none
    assert len(report.left_out) == 1
    assert "sofa" not in report.without_room
    files = {name: (folder / name).read_bytes() for name in COMPETITION_FILES}
    files[LOCATIONS] = files[LOCATIONS].replace(b"sofa (p)", b"sofa")
    assert import_competition("home", files).changes.changed == 1
    ((_, _, _, attributes),) = entities(text="sofa")
    assert attributes == {"isBeacon": "true", "isPlacement": "false", "room": "living room"}
    import_competition("home", folder)
    assert entities(text="coke")[0][2] == ["cola"]
    assert not entities(text="milk")
    import_competition("home", folder, brings_back=True)
    assert entities(text="milk")


def test_the_report_names_what_published_generators_lose(world, folder):
    report = import_competition("home", folder)
    assert report.lost == {"2025": {"location": 1}, "April 2026": {"location": 8}}
    places = {(each.position.source, each.position.line) for each in report.problems}
    assert places == {(LOCATIONS, line) for line in (6, 8, 10, 14, 16, 19, 21, 23)}
    assert import_competition("home", folder).problems == report.problems


def test_the_report_names_what_the_grammar_has_no_entity_for_any_more(world, folder, shared_data):
    import_generator("home", shared_data / "generator-2018")
    report = import_competition("home", folder)
    places = [
        (each.position.source, each.position.line)
        for each in report.problems
        if each.position.source != LOCATIONS
    ]
    alike = ("gpsr_category_2_grammar.txt", 17)  # {aobject}
    cereal = ("gpsr_category_3_semantics.txt", 33)
    assert alike in places and cereal in places
    assert not report.is_refused
    assert import_competition("home", folder).problems == report.problems


def test_nothing_is_stored_where_a_file_has_an_error(world, folder, tmp_path):
    import_competition("home", folder)
    before = entities()
    shutil.copytree(folder, tmp_path / "event" / "data", copy_function=shutil.copy)
    broken = tmp_path / "event" / "data" / NAMES
    broken.write_text("| Names |\n| Ada |\n")
    report = import_competition("home", tmp_path / "event")
    assert [(each.position.source, each.position.line) for each in report.errors] == [(NAMES, 1)]
    assert entities() == before
    assert import_competition("nowhere", tmp_path / "event").is_refused
    assert not World.objects.filter(name="nowhere").exists()


def test_of_several_competitions_one_is_chosen(world, shared_data, folder):
    report = import_competition("home", shared_data / "competition-real")
    assert report.is_waiting and "incheon2026" in report.arenas and len(report.arenas) == 4
    assert not entities()
    import_competition("home", shared_data / "competition-real", arena="Incheon2026")
    chosen = entities()
    assert import_competition("home", folder).changes.is_none and entities() == chosen


def test_the_command_says_what_it_did(db, folder, tmp_path):
    told, failure = run("import_competition", folder, "--world", "c26")
    assert failure is None and told["changes"]["added"] == 72
    _, failure = run("import_competition", tmp_path, "--world", "c26")
    assert failure is not None
