"""Which rows of a competition's folder the published generators lose, and whether the hint is enough to save them."""

from __future__ import annotations

from collections import Counter
from time import process_time

import pytest

from annotations.language.world.competition_folder import (
    COMPETITION_FILES,
    LOCATIONS,
    NAMES,
    OBJECTS,
    ROOMS,
    read_competition,
)
from annotations.language.world.published_generators import (
    PUBLISHED_GENERATORS,
    lost_rows,
    warnings_of_lost,
)
from tests.annotations.language.world.test_competition_folder import FOLDER, MOST_SECONDS

OLDER, NEWER = PUBLISHED_GENERATORS
HEAD = "| Number | Name | Object Category |\n| - | - | - |\n| 0 | table (p) | drinks |\n"
WHOLE = {
    **FOLDER,
    NAMES: "| Names |\n| --- |\n| Ada |\n",
    LOCATIONS: HEAD,
}


def lost_in(**changes: str) -> list[tuple[str, str, str]]:
    """Return generator, name and what is read instead, for each row that is lost of ``WHOLE`` with other files."""
    places = {"names": NAMES, "rooms": ROOMS, "locations": LOCATIONS, "objects": OBJECTS}
    files = {**WHOLE, **{places[name]: text for name, text in changes.items()}}
    return _lost({name: text.encode() for name, text in files.items()})


def _lost(files):
    ontology, problems = read_competition(files)
    assert not [each for each in problems if each.is_error]
    return [(each.generator, each.entity.text, each.misread) for each in lost_rows(files, ontology)]


def test_a_whole_folder_loses_nothing():
    assert lost_in() == []


@pytest.mark.parametrize("name", ["Antônia", "Anne-Marie", "Mary Ann", "R2"])
def test_names_of_more_than_letters_are_lost_by_both(name):
    lost = lost_in(names=f"| Names |\n| - |\n| Ada |\n| {name} |\n")
    assert lost == [(OLDER, name, ""), (NEWER, name, "")]


@pytest.mark.parametrize(
    ("rooms", "lost"),
    [
        ("| Name |\n| - |\n| utility room |\n| hall |", []),
        ("| Name |\n| - |\n| old living room |\n| hall |", ["old living room"]),
        ("| Name |\n| - |\n|hall|\n| attic |", ["hall"]),
        ("|Name|\n| - |\n| hall |\n| attic |", ["hall"]),  # taken for the head
        ("Name |\n|-|\n| hall\n| attic\n| bath |", ["hall", "attic", "bath"]),
    ],
)
def test_rooms_are_one_or_two_words_and_a_blank(rooms, lost):
    assert [name for generator, name, _ in lost_in(rooms=rooms) if generator == NEWER] == lost


@pytest.mark.parametrize(
    ("rows", "older", "newer"),
    [
        ("| 1 | bed |\n| 2 | sofa | |\n", [], ["sofa"]),
        ("| 1 | bed | |\n| 2 | sofa | |\n", [], []),
        ("| 1 | bed | |\n| 2 | sofa |\n", [], ["sofa"]),
        ("| 1 | bed\n| 2 | sofa | |\n", ["sofa"], ["bed"]),
        ("| 1 | café |  |\n", ["café"], ["café"]),
        ("| 1 | desk 2 |  |\n", ["desk 2"], ["desk 2"]),
        ("| one | desk | |\n", ["desk"], ["desk"]),
        ("| 1 | bed | - |\n| 2 | sofa | drinks |\n", [], ["bed"]),
        ("| 1 | bed, sofa |  |\n", [], ["bed, sofa"]),
    ],
)
def test_rows_of_locations_depend_on_the_strokes_around_them(rows, older, newer):
    lost = lost_in(locations=HEAD + rows)
    assert [name for generator, name, _ in lost if generator == OLDER] == older
    assert [name for generator, name, _ in lost if generator == NEWER] == newer


def test_a_class_without_a_stroke_before_it_is_read_as_part_of_the_name():
    lost = lost_in(locations=HEAD + "| 1 | bed (p) drinks |\n")
    assert lost == [(OLDER, "bed", "bed drinks"), (NEWER, "bed", "")]


@pytest.mark.parametrize(
    ("heading", "lost"),
    [
        ("# Class toys (toy)", []),
        ("# Class toys", [(OLDER, "toys"), (NEWER, "toys"), (NEWER, "dice")]),
        ("# Class soft_toys (soft_toy)", []),
        (
            "# Class soft toys (soft toy)",
            [(OLDER, "soft toys"), (NEWER, "soft toys"), (NEWER, "dice")],
        ),
        ("# class toys (toy)", [(OLDER, "toys"), (NEWER, "toys"), (NEWER, "dice")]),
    ],
)
def test_a_class_needs_its_singular(heading, lost):
    table = "| Objectname | Image |\n| - | - |\n| dice | |\n"
    read = lost_in(objects=f"{heading}\n\n{table}", locations=HEAD.replace("drinks", ""))
    assert [each[:2] for each in read] == lost


@pytest.mark.parametrize("name", ["tom-yam", "biscuit roll", "dice (tiny)"])
def test_objects_are_one_word(name):
    row = f"| {name} | |\n"
    assert {each[0] for each in lost_in(objects=FOLDER[OBJECTS] + row)} == {OLDER, NEWER}


LOST_IN_2026 = ["shelf", "bed", "sofa", "counter", "cooking table", "dinner table", "coat rack", "exit"]  # fmt: skip


def test_the_rows_that_the_world_cup_of_2026_loses_are_named(shared_data):
    folder = shared_data / "competition-real" / "Incheon2026"
    lost = _lost({name: (folder / name).read_bytes() for name in COMPETITION_FILES})
    assert [name for generator, name, _ in lost if generator == NEWER] == LOST_IN_2026
    assert 20 - len(LOST_IN_2026) == 12
    assert [each[1:] for each in lost if each[0] == OLDER] == [
        ("cooking table", "cooking table cleaning supplies")
    ]


def test_real_folders_lose_what_was_counted_by_hand(shared_data):
    counts = {}
    for name in ("at-home-2025", "GermanOpen2024", "PortugalOpen2026"):
        folder = shared_data / "competition-real" / name
        lost = _lost({each: (folder / each).read_bytes() for each in COMPETITION_FILES})
        counts[name] = Counter(generator for generator, *_ in lost)
    assert counts["at-home-2025"] == {OLDER: 4, NEWER: 4}  # objects with hyphens or blanks
    assert counts["GermanOpen2024"] == {OLDER: 7, NEWER: 7 + 46 + 7}  # no class has a singular
    assert counts["PortugalOpen2026"] == {NEWER: 12}


def test_a_warning_stands_at_its_row_and_names_the_generators():
    files = {name: text.encode() for name, text in WHOLE.items()}
    files[NAMES] += "| Gabriëlle |\n".encode()
    files[LOCATIONS] += b"| 1 | bed |\n| 2 | sofa | |\n"
    ontology, _ = read_competition(files)
    bed, name = warnings_of_lost(lost_rows(files, ontology))
    assert (bed.position.source, bed.position.line, bed.position.column) == (LOCATIONS, 5, 7)
    assert (name.position.source, name.position.line) == (NAMES, 4)
    assert not (bed.is_error or name.is_error)
    assert NEWER in bed.message and OLDER not in bed.message and "| 1 | bed | |" in bed.hint
    assert NEWER in name.message and OLDER in name.message and "Gabrielle" in name.hint


@pytest.mark.parametrize(
    "names",
    [
        "".join(f"| é{number} |\n" for number in range(19_000)),
        f"| Zoë {'|' * 1_000_000}\n",
        f"| Zoë {'| ' * 100_000}\n| Eve | {' ' * 100_000}",
        f"| Zoë |\n{'prose ' * 100_000}\n",
    ],
)
def test_large_files_take_less_than_two_seconds(names):
    files = {name: text.encode() for name, text in WHOLE.items()}
    files[NAMES] += names.encode()
    began = process_time()
    ontology, _ = read_competition(files)
    assert warnings_of_lost(lost_rows(files, ontology))
    assert process_time() - began < MOST_SECONDS


HINTS = {
    "names": ("| Names |\n| - |\n| Ada |\n| {} |\n", ["Zoë"]),
    "objects": (FOLDER[OBJECTS] + "| {} | |\n", ["tom-yam cup", "lay's stax"]),
    "locations": (HEAD + "| 1 | {} | |\n", ["café table"]),
}


@pytest.mark.parametrize("file", HINTS)
def test_what_a_hint_says_to_write_is_read(file):
    text, names = HINTS[file]
    for name in names:
        files = {each: content.encode() for each, content in WHOLE.items()}
        place = {"names": NAMES, "objects": OBJECTS, "locations": LOCATIONS}[file]
        files[place] = text.format(name).encode()
        ontology, _ = read_competition(files)
        (warning,) = warnings_of_lost(lost_rows(files, ontology))
        assert lost_in(**{file: text.format(warning.hint.removeprefix("write "))}) == []
