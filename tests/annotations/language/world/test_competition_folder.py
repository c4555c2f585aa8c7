"""The Markdown folder of a competition: real ones, every quirk of theirs, and broken ones."""

from __future__ import annotations

import json
from time import process_time

import pytest

from annotations.language.world.competition_folder import (
    COMPETITION_FILES,
    LOCATIONS,
    NAMES,
    OBJECTS,
    ROOMS,
    choose_files,
    guess_room,
    read_competition,
)

FOLDER = {
    NAMES: "## Names\n| Names |\n| --- |\n| Ada |\n| Antônia |\n",
    ROOMS: "| Name |\n| --- |\n| kitchen |\n| living room |\n",
    LOCATIONS: "| Number | Name | Object Category\n| --- | --- | --- |\n"
    "| 1 | side table (p) | drinks |\n| 2 | sofa |\n",
    OBJECTS: "# Class drinks (drink)\n\n| Objectname | Image |\n|:---:|:---:|\n| red_bull | ![](a.png) |\n",
}
MOST_SECONDS = 2  # of processor time


def read(**changes: str | bytes):
    """Read ``FOLDER`` with other contents: ``names``, ``rooms``, ``locations``, ``objects``."""
    places = {"names": NAMES, "rooms": ROOMS, "locations": LOCATIONS, "objects": OBJECTS}
    files = {**FOLDER, **{places[name]: content for name, content in changes.items()}}
    return read_competition(
        {
            name: text if isinstance(text, bytes) else text.encode()
            for name, text in files.items()
            if text is not None
        }
    )


def texts(ontology, entity_class):
    return [each.text for each in ontology.of_class(entity_class)]


def found_in(folder):
    """What ``expected.json`` says of a folder."""
    files = {name: (folder / name).read_bytes() for name in COMPETITION_FILES}
    ontology, problems = read_competition(files)
    locations, categories = ontology.of_class("location"), ontology.texts_of("category")
    found = {
        "names": texts(ontology, "name"),
        "rooms": texts(ontology, "room"),
        "locations": [each.text for each in locations],
        "placements": [each.text for each in locations if each.is_set("isPlacement")],
        "objects": texts(ontology, "object"),
        "plural": list(categories),
        "singular": [ontology.singular(each) for each in categories],
    }
    return found, problems


def test_real_folders_are_read_as_a_careful_reader_does(shared_data):
    real = shared_data / "competition-real"
    expected = json.loads((real / "expected.json").read_text(encoding="utf-8"))
    assert len(expected) == 4
    for name, rows in expected.items():
        found, problems = found_in(real / name)
        assert (name, found, problems) == (name, rows, ())


def test_the_folder_of_the_generator_is_read(shared_data):
    found, problems = found_in(shared_data / "competition-2025")
    assert not problems
    assert {name: len(rows) for name, rows in found.items()}["locations"] == 25


def test_attributes_are_those_of_generator_files():
    ontology, problems = read()
    assert not problems
    (category,) = ontology.of_class("category")
    assert category.attributes == {"defaultLocation": "side table", "singular": "drink"}
    table, sofa = ontology.of_class("location")
    assert (table.is_set("isPlacement"), sofa.is_set("isPlacement")) == (True, False)
    assert table.position.line == 3 and table.attribute("room") is None
    (bull,) = ontology.of_class("object")
    assert (bull.text, bull.attributes) == ("red bull", {"category": "drinks"})
    assert texts(ontology, "name") == ["Ada", "Antônia"]


@pytest.mark.parametrize(
    ("rows", "names"),
    [
        ("Names |\n---|\nAda |\nBob |", ["Ada", "Bob"]),
        ("| Names\n| ---\n| Ada\n| Bob", ["Ada", "Bob"]),
        ("|\tNames\t|\n| :--: |\n|\t Ada\t|\n\n| Bob |\n", ["Ada", "Bob"]),
        (
            "![team](a|b.png)\n\nAll names\n\n| Names |\n|-|\n| Ada |\n| Bob |\n\n- a | list\n",
            ["Ada", "Bob"],
        ),
        ("| Names |\n| - |\n| Ada |\n| - |\n| Bob |", ["Ada", "Bob"]),
    ],
)
def test_tables_are_written_in_many_ways(rows, names):
    ontology, problems = read(names=rows)
    assert texts(ontology, "name") == names
    assert not problems


@pytest.mark.parametrize(
    ("row", "text", "is_placement", "category"),
    [
        ("| 1 | bed (p)| drinks |", "bed", True, "bed"),
        ("| 1 | bed(p) | Drink", "bed", True, "bed"),
        ("| 1 | bed | DRINKS |", "bed", False, "bed"),
        ("| 1 | cooking table (p) drinks |", "cooking table", True, "cooking table"),
        ("| 1 | Kitchen Counter (p) |", "Kitchen Counter", True, None),
        ("| 1 | bed (p) |  |", "bed", True, None),
        ("1 | bed (p) | -", "bed", True, None),
        ("| 1 | bed (p) | food, drinks |", "bed", True, "bed"),
    ],
)
def test_rows_of_locations_are_written_in_many_ways(row, text, is_placement, category):
    objects = FOLDER[OBJECTS] + "# Class food\n| Objectname | Image |\n| - | - |\n| corn | |\n"
    head = "| Number | Name | Object Category |\n| - | - | - |\n| 0 | x (p) |\n"
    ontology, problems = read(locations=head + row, objects=objects)
    assert not problems
    location = ontology.of_class("location")[1]
    assert (location.text, location.is_set("isPlacement")) == (text, is_placement)
    drinks = next(each for each in ontology.of_class("category") if each.text == "drinks")
    assert drinks.attribute("defaultLocation") == category


@pytest.mark.parametrize(
    ("heading", "plural", "singular"),
    [
        ("# Class cleaning_supplies (cleaning_supply) ", "cleaning supplies", "cleaning supply"),
        ("## class toys", "toys", "toys"),
        ("# Class food (food)", "food", "food"),
    ],
)
def test_headings_of_classes(heading, plural, singular):
    table = "\n| Objectname | Image |\n| --- | --- |\n| dice (tiny) | ![](x) |\n| 7up | |\n"
    ontology, problems = read(
        objects=heading + table, locations=FOLDER[LOCATIONS].replace("drinks", "")
    )
    assert not problems
    assert ontology.texts_of("category") == (plural,)
    assert ontology.singular(plural) == singular
    dice, seven = ontology.of_class("object")
    assert (dice.text, dice.attribute("remark"), seven.text) == ("dice", "tiny", "7up")


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"names": "| Names |\n| - |\n| Ada |\n| Ada |"}, 4),
        ({"locations": FOLDER[LOCATIONS] + "| 3 | sofa |"}, 5),
        ({"locations": FOLDER[LOCATIONS].replace("drinks", "cutlery")}, 3),
        ({"objects": FOLDER[OBJECTS] + "| red bull | |"}, 6),
        ({"objects": FOLDER[OBJECTS] + "# Class toys\n" + FOLDER[OBJECTS].split("\n\n")[1]}, 9),
    ],
)
def test_what_stands_twice_or_fits_nothing_is_a_warning(changes, line):
    _, problems = read(**changes)
    assert [(each.is_error, each.position.line) for each in problems] == [(False, line)]


LONG = "| Names |\n| - |\n" + "| a |\n" * 1_000_000
BROKEN = {
    "no ruler": ({"names": "| Names |\n| Ada |\n"}, NAMES, 1),
    "no table": ({"rooms": "kitchen\nliving room\n"}, ROOMS, 1),
    "nothing": ({"rooms": ""}, ROOMS, 1),
    "an empty cell": ({"names": "| Names |\n| - |\n| Ada |\n|  |\n"}, NAMES, 4),
    "a row without a name": ({"locations": FOLDER[LOCATIONS] + "| 3 |"}, LOCATIONS, 5),
    "two classes of one name": ({"objects": FOLDER[OBJECTS] * 2}, OBJECTS, 6),
    "a table of no class": (
        {"objects": "# Things\n" + FOLDER[OBJECTS].split("\n\n")[1]},
        OBJECTS,
        1,
    ),
    "no placement": ({"locations": FOLDER[LOCATIONS].replace("(p)", "")}, LOCATIONS, 1),
    "a picture": ({"objects": b"\x89PNG\r\n\x1a\n\x00\x00\xff\xfe"}, OBJECTS, 1),
    "UTF-16": ({"names": FOLDER[NAMES].encode("utf-16")}, NAMES, 1),
    "Latin-1": ({"names": FOLDER[NAMES].encode("latin-1")}, NAMES, 5),
    "a million rows": ({"names": LONG}, NAMES, 1),
    "a script": ({"names": "| Names |\n| - |\n| <script>x</script> |"}, NAMES, 3),
    "a long name": ({"rooms": "| Name |\n| - |\n| " + "k" * 501 + " |"}, ROOMS, 3),
    "three million names in a cell": (
        {
            "locations": "| No | Name | C |\n| - | - | - |\n| 1 | sofa (p) | "
            + "a," * 3_000_000
            + " |"
        },
        LOCATIONS,
        3,
    ),
    "a quotation mark": ({"rooms": '| Name |\n| - |\n| the "room" |'}, ROOMS, 3),
    "a million strokes": ({"names": "| Names |\n| - |\n" + "|" * 1_000_000}, NAMES, 3),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_folders_are_refused_with_the_place(name):
    changes, file, line = BROKEN[name]
    began = process_time()
    _, problems = read(**changes)
    assert process_time() - began < MOST_SECONDS
    errors = [(each.position.source, each.position.line) for each in problems if each.is_error]
    assert errors == [(file, line)]


@pytest.mark.parametrize(
    ("path", "place"),
    [
        ("names.md", NAMES),
        ("names/names.md", NAMES),
        ("RoboCup2026/Maps/Location_Names.md", LOCATIONS),
        ("a/objects/objects.md", OBJECTS),
        ("objects/test_objects.md", ""),
        ("objects/test.md", ""),
        ("names/drinks.md", ""),
        ("questions/questions.md", ""),
        ("README.md", ""),
    ],
)
def test_other_files_are_no_part_of_the_language(path, place):
    assert choose_files([path]).paths == ({place: path} if place else {})


ARENAS = [
    "x/names/names.md",
    *(f"x/maps/{kind}_names_{arena}.md" for kind in ("room", "location") for arena in "ab"),
    *("x/objects/objects_a.md", "x/objects/Objects-B.md", "x/README.md"),
]


def test_of_two_arenas_one_is_chosen_and_what_they_share_is_in_both():
    assert choose_files(ARENAS).arenas == ("a", "b")
    for arena in ("a", "B"):
        choice = choose_files(ARENAS, arena)
        assert set(choice.paths) == set(COMPETITION_FILES) and not choice.problems
        assert choice.paths[NAMES] == "x/names/names.md"
        assert choice.paths[OBJECTS].lower()[-4] == arena.lower()
    for folder in ("{}/maps", "maps/{}"):
        paths = [f"{folder.format(arena)}/room_names.md" for arena in "xy"]
        assert choose_files(paths).arenas == ("x", "y")


def test_a_file_for_all_is_taken_before_those_of_arenas():
    assert choose_files([*ARENAS, "x/objects/objects.md"]).paths[OBJECTS] == "x/objects/objects.md"


@pytest.mark.parametrize("lost", COMPETITION_FILES)
def test_a_missing_file_is_one_problem_that_names_what_lies_beside_it(lost):
    beside = f"{lost.split('/')[0]}/places.md"
    paths = [each for each in COMPETITION_FILES if each != lost]
    choice = choose_files(paths, others=[beside])
    (problem,) = choice.problems
    assert problem.position.source == lost and "places.md" in problem.hint
    _, further = read_competition({each: FOLDER[each].encode() for each in paths})
    assert further == ()


@pytest.mark.parametrize(
    ("location", "room"),
    [
        ("kitchen trash bin", "kitchen"),
        ("bedside table", "bedroom"),
        ("Living Room shelf", "living room"),
        ("living table", "living room"),
        ("bathtub", "bathroom"),
        ("guest bedroom closet", "guest bedroom"),
        ("sofa", ""),
        ("roomy shelf", ""),
        ("kitchen bedroom door", ""),
    ],
)
def test_a_room_is_guessed_from_the_name_of_a_location(location, room):
    rooms = ["kitchen", "living room", "bathroom", "bedroom"]
    if room not in ("", *rooms):
        rooms.append(room)
    assert guess_room(location, rooms) == room
