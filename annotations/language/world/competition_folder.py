"""Read the folder of a competition since 2024: Markdown with names, rooms, locations and objects.

Such a folder holds ``names/names.md``, ``maps/room_names.md``, ``maps/location_names.md`` and ``objects/objects.md``
(docs/reference/formats.md, Competition folders). All other files are no part of the language.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from annotations.language.texts import (
    LanguageError,
    Position,
    Problem,
    error_at,
    read_text,
    spellings,
    warning_at,
)
from annotations.language.world.entities import Entity, Ontology
from annotations.language.world.ontology_checks import ontology_problems

NAMES, ROOMS = "names/names.md", "maps/room_names.md"
LOCATIONS, OBJECTS = "maps/location_names.md", "objects/objects.md"
COMPETITION_FILES = (NAMES, ROOMS, LOCATIONS, OBJECTS)
# File → the classes of what it lists.
_LISTED = {
    NAMES: ("name",),
    ROOMS: ("room",),
    LOCATIONS: ("location",),
    OBJECTS: ("object", "category"),
}
COMPETITION_CLASSES = frozenset(name for names in _LISTED.values() for name in names)

MOST_LINES = 20_000  # of a file
MOST_CELLS = 20  # of a row that are told apart
MOST_NAMES = 50  # of one cell
MOST_PROBLEMS = 1_000  # unknown classes that are named
MOST_NAMED = 6  # files that a hint names
_ONE_FOLDER = "choose the folder of one competition"
_PLACEMENT = re.compile(r"\( ?p ?\)", re.IGNORECASE)
_PROSE = ("- ", "* ", "+ ", "![", "[", ">")  # begins of lists, pictures, links and quotations
_NOTHING = ("", "-", "–", "—")
_NO_NAME = re.compile(r"[^\w .,'’&/+\-]")


@dataclass(frozen=True, slots=True)
class Cell:
    """The text of a cell, with single spaces, and where it stands."""

    text: str
    position: Position


@dataclass(slots=True)
class Table:
    """A table below a ``heading``: the cells of its head and of its rows, without the ruler."""

    heading: Cell
    head: list[Cell]
    rows: list[list[Cell]] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class FolderChoice:
    """Which paths are read: one of ``COMPETITION_FILES`` → path. With ``arenas`` one of them has to be chosen first.

    ``problems`` say which files are missing, or are there twice.
    """

    paths: Mapping[str, str]
    arenas: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()


def may_be_in_folder(path: str) -> bool:
    """Return whether a file may be one of ``COMPETITION_FILES``, or one of an arena such as ``objects_b.md``."""
    return any(_arena_in(path, place) is not None for place in COMPETITION_FILES)


def choose_files(paths: Iterable[str], arena: str = "", others: Iterable[str] = ()) -> FolderChoice:
    """Find the files of a competition among ``paths``, whatever folders they lie in.

    Where a file is there for several arenas only, that of ``arena`` is taken.

    Args:
        others: paths beside them, which a missing file may be called.
    """
    paths, others = list(paths), list(others)
    chosen: dict[str, str] = {}
    arenas: dict[str, None] = {}
    problems: list[Problem] = []
    for place in COMPETITION_FILES:
        found: dict[str, list[str]] = defaultdict(list)
        for path in paths:
            if (label := _arena_in(path, place)) is not None:
                found[label].append(path)
        if len(found.get("", ())) > 1:  # told apart by the folders around them
            for path in found.pop(""):
                folders = path.lower().split("/")[:-1]
                around = [each for each in folders if each != place.partition("/")[0]]
                found[around[-1] if around else ""].append(path)
        label = arena.lower() if arena.lower() in found else ""
        if label not in found and len(found) == 1:
            (label,) = found
        if label in found:
            chosen[place] = found[label][0]
            problems += (
                error_at(Position(path), f"there are two files {place}", _ONE_FOLDER)
                for path in found[label][1:]
            )
        elif found and not arena:
            arenas.update(dict.fromkeys(found))
        else:
            problems.append(_missing(place, list(found), [*paths, *others]))
    if problems and not chosen and not arenas:
        sentence = "none of the files of a competition is here"
        problems = [error_at(Position(), sentence, f"they are {', '.join(COMPETITION_FILES)}")]
    return FolderChoice(chosen, tuple(sorted(arenas)), tuple(problems))


def _arena_in(path: str, place: str) -> str | None:
    """Return the arena whose file ``place`` stands at ``path``, empty for that of all; None for another file."""
    *folders, name = path.lower().split("/")
    folder, _, known = place.partition("/")
    stem, rest = known.removesuffix(".md"), name.removesuffix(".md")
    if not name.endswith(".md") or (folders and folder not in folders[-2:]):
        return None
    if rest == stem:
        return folders[-1] if folders and folders[-1] != folder else ""
    begins = rest.startswith(stem) and rest[len(stem)] in "_-. ("
    return rest[len(stem) :].strip("_-. ()") if begins else None


def _missing(place: str, arenas: list[str], paths: list[str]) -> Problem:
    folder = place.partition("/")[0]
    beside = sorted(path for path in paths if f"/{folder}/" in f"/{path.lower()}") or sorted(paths)
    names = ", ".join(path.rsplit("/", 1)[-1] for path in beside[:MOST_NAMED])
    hint = f"beside it lie {names}" if names else "add it, or choose the folder around it"
    if arenas:
        hint = f"it is there for {', '.join(sorted(arenas)[:MOST_NAMED])}"
    return error_at(Position(place), "the folder has no such file", hint)


def read_competition(files: Mapping[str, bytes]) -> tuple[Ontology, tuple[Problem, ...]]:
    """Read the files of a folder, given as one of ``COMPETITION_FILES`` → content.

    Locations have no room, since the folder does not say it: it is asked for apart. A category stands once for each
    location where its objects belong.

    Returns:
        The rows, and every problem with its place; errors are returned, not raised. Where a file is missing, nothing
        but what is wrong with the tables of the others.
    """
    problems: list[Problem] = []
    tables = {name: _tables(files, name, problems) for name in files}
    if len(tables) < len(
        COMPETITION_FILES
    ):  # what else there is to say follows from what is missing
        return Ontology(()), tuple(sorted(problems))
    names = list(_read_column(tables[NAMES], "name", ("name", "names"), problems))
    rooms = list(_read_column(tables[ROOMS], "room", ("name", "names", "room", "rooms"), problems))
    locations, belongs = _read_locations(tables[LOCATIONS], problems)
    objects = list(_read_objects(tables[OBJECTS], belongs, problems))
    ontology = Ontology((*objects, *rooms, *locations, *names))
    problems += ontology_problems(ontology)
    return ontology, tuple(sorted(problems))


def _tables(files: Mapping[str, bytes], name: str, problems: list[Problem]) -> list[Table]:
    """Return the tables of a file; none, and an error, where it cannot be read."""
    try:
        text, changes = read_text(files[name], name)
        problems += changes
        lines = text.split("\n")
        if len(lines) > MOST_LINES:
            raise LanguageError(
                f"the file has {len(lines):,} lines", Position(name), f"{MOST_LINES:,} is the limit"
            )
    except LanguageError as error:
        problems.append(error.problem)
        return []
    found = list(_find_tables(lines, name, problems))
    if not found and not any(each.position.source == name for each in problems):
        problems.append(
            error_at(
                Position(name),
                "there is no table here",
                "write | Name | below it a ruler, then rows",
            )
        )
    return found


def _find_tables(lines: list[str], name: str, problems: list[Problem]) -> Iterator[Table]:
    """Yield each table, which a ruler makes of the line above it; rows go on up to the next heading or table."""
    heading, table = Cell("", Position(name)), None
    is_inside = False  # whether the line above belongs to a table
    for number, line in enumerate(lines, start=1):
        place = Position(name, number)
        stripped = line.strip()
        below = lines[number].strip() if number < len(lines) else ""
        is_row = "|" in stripped and not stripped.startswith(_PROSE)
        if is_inside and _is_ruler(stripped):
            continue
        if stripped.startswith("#"):
            if table is not None:
                yield table
            heading, table = Cell(" ".join(stripped.strip("#").split()), place), None
        elif is_row and not is_inside and _is_ruler(below):
            if table is not None:
                yield table
            table = Table(heading, _cells(line, name, number))
        elif is_row and table is not None:
            table.rows.append(_cells(line, name, number))
        elif stripped.startswith("|") and not is_inside:
            hint = "write | --- | below its head"
            problems.append(error_at(place, "this table has no ruler", hint))
        is_inside = is_row
    if table is not None:
        yield table


def _is_ruler(line: str) -> bool:
    """Return whether a line, without blanks around it, stands between the head of a table and its rows."""
    return "-" in line and not line.strip("|:- \t")


def _cells(line: str, name: str, number: int) -> list[Cell]:
    """Return the cells of a row. Its first and its last stroke may be missing."""
    start = len(line) - len(line.lstrip())
    inner = line.strip()
    if inner.startswith("|"):
        start, inner = start + 1, inner[1:]
    cells, at = [], start
    for text in inner.removesuffix("|").split("|", MOST_CELLS):
        column = at + len(text) - len(text.lstrip()) + 1
        cells.append(Cell(" ".join(text.split()), Position(name, number, column)))
        at += len(text) + 1
    return cells


def _read_column(
    tables: Iterable[Table], entity_class: str, heads: tuple[str, ...], problems: list[Problem]
) -> Iterator[Entity]:
    """Yield the rows of the first column that is called one of ``heads``."""
    seen: set[str] = set()
    for table in tables:
        at = _column(table, heads)
        if at is None:
            continue
        for row in table.rows:
            cell = row[at] if at < len(row) else row[0]
            if _require_name(cell, entity_class, seen, problems):
                yield Entity(entity_class, cell.text, position=cell.position)


def _column(table: Table, heads: tuple[str, ...]) -> int | None:
    titles = [cell.text.casefold() for cell in table.head]
    return next((at for at, title in enumerate(titles) if title in heads), None)


def _require_name(cell: Cell, entity_class: str, seen: set[str], problems: list[Problem]) -> bool:
    """Return whether a cell holds a new name. Say what is wrong with one that does not."""
    if cell.text in _NOTHING[1:]:
        return False  # a place that was left free
    if not cell.text:
        problems.append(
            error_at(cell.position, f"this {entity_class} has no name", "write it here")
        )
    elif odd := _NO_NAME.search(cell.text):
        place = cell.position.shifted(odd.start())
        problems.append(
            error_at(
                place, f"a name cannot have the character {odd[0]}", "write letters and digits"
            )
        )
    elif cell.text.casefold() in seen:
        problems.append(
            warning_at(cell.position, f"{cell.text} stands here twice", "keep one of the rows")
        )
    else:
        seen.add(cell.text.casefold())
        return True
    return False


def _read_locations(
    tables: Iterable[Table], problems: list[Problem]
) -> tuple[list[Entity], dict[str, list[Cell]]]:
    """Return the locations, and location → the cells that name what belongs there."""
    locations: list[Entity] = []
    belongs: dict[str, list[Cell]] = defaultdict(list)
    seen: set[str] = set()
    for table in tables:
        at = _column(table, ("name", "names"))
        if at is None:
            continue
        for row in table.rows:
            if at >= len(row):
                place = row[-1].position
                problems.append(error_at(place, "this row has no name", "write number, name"))
                continue
            place = row[at].position
            parts = [part.strip() for part in _PLACEMENT.split(row[at].text, maxsplit=1)]
            if not _require_name(Cell(parts[0], place), "location", seen, problems):
                continue
            is_placement = len(parts) > 1
            attributes = {"isBeacon": "true", "isPlacement": "true" if is_placement else "false"}
            locations.append(Entity("location", parts[0], (), attributes, place))
            # "cooking table (p) cleaning supplies": somebody forgot the stroke between two cells.
            beside = [Cell(parts[1], place)] if is_placement and parts[1] else []
            for cell in (*row[at + 1 : at + 2], *beside):
                named = cell.text.split(",", MOST_NAMES)
                if len(named) > MOST_NAMES:
                    sentence = f"a cell has more than {MOST_NAMES} names"
                    problems.append(error_at(cell.position, sentence, "name each class once"))
                    continue
                for text in named:
                    if text.strip() not in _NOTHING:
                        belongs[parts[0]].append(Cell(text.strip(), cell.position))
    if locations and not any(each.is_set("isPlacement") for each in locations):
        problems.append(
            error_at(
                Position(LOCATIONS),
                "no location has (p), so nothing can be put anywhere",
                "write (p) after the names of locations where objects can be placed",
            )
        )
    return locations, belongs


def _read_objects(
    tables: Iterable[Table], belongs: Mapping[str, list[Cell]], problems: list[Problem]
) -> Iterator[Entity]:
    """Yield the categories, one for each place where their objects belong, each before its objects."""
    # Folded plural → the plural with its place, the singular, the objects.
    classes: dict[str, tuple[Cell, str, list[Entity]]] = {}
    homes: dict[str, str] = {}  # folded object → its first class
    for table in tables:
        heading = table.heading
        plural, singular = _names_of_class(heading.text)
        if not plural:
            problems.append(
                error_at(
                    heading.position,
                    "this table belongs to no class",
                    "write # Class drinks (drink)",
                )
            )
            continue
        if plural.casefold() in classes:
            problems.append(
                error_at(
                    heading.position, f"there are two classes {plural}", "give one another name"
                )
            )
            continue
        objects: list[Entity] = []
        classes[plural.casefold()] = Cell(plural, heading.position), singular, objects
        seen: set[str] = set()
        for row in table.rows:
            text, _, remark = row[0].text.replace("_", " ").partition("(")
            named = Cell(" ".join(text.split()), row[0].position)
            if not _require_name(named, "object", seen, problems):
                continue
            first = homes.setdefault(named.text.casefold(), plural)
            if first != plural:
                sentence = f"{named.text} is among the {first} too"
                problems.append(warning_at(named.position, sentence, "both are kept"))
            said = remark.partition(")")[0].strip()
            attributes = {"category": plural, **({"remark": said} if said else {})}
            objects.append(Entity("object", named.text, (), attributes, named.position))
    places = _places_of(classes, belongs, problems)
    for key, (named, singular, objects) in classes.items():
        attributes = {"singular": singular} if singular != named.text else {}
        for place in places[key] or [""]:
            kept = {"defaultLocation": place} if place else {}
            yield Entity("category", named.text, (), {**kept, **attributes}, named.position)
        yield from objects


def _names_of_class(heading: str) -> tuple[str, str]:
    """Return plural and singular of ``Class drinks (drink)``, the plural twice without a singular; nothing for another
    heading."""
    word, _, names = heading.replace("_", " ").partition(" ")
    if word.casefold() != "class":
        return "", ""
    plural, _, rest = names.partition("(")
    singular = " ".join(rest.partition(")")[0].split())
    plural = " ".join(plural.split())
    return plural, singular or plural


def _places_of(
    classes: Mapping[str, tuple[Cell, str, list[Entity]]],
    belongs: Mapping[str, list[Cell]],
    problems: list[Problem],
) -> dict[str, list[str]]:
    """Return folded plural → the locations where the objects of a class belong, as the map says it in plural or
    singular."""
    names: dict[str, str] = {}
    for key, (plural, singular, _) in classes.items():
        for name in (plural.text, singular):
            names.setdefault(_fold(name), key)
    known = {each: key for name, key in names.items() for each in spellings(name)} | names
    places: dict[str, list[str]] = defaultdict(list)
    unknown: set[str] = set()
    for location, cells in belongs.items():
        for cell in cells:
            said = _fold(cell.text)
            named = next((known[each] for each in (said, *spellings(said)) if each in known), None)
            if named is None and len(unknown) < MOST_PROBLEMS and cell.text not in unknown:
                unknown.add(cell.text)
                sentence = f"no objects are of the class {cell.text}"
                problems.append(warning_at(cell.position, sentence, "name a class of objects.md"))
            elif named is not None and location not in places[named]:
                places[named].append(location)
    return places


def _fold(name: str) -> str:
    """Return a name without case and underscores."""
    return " ".join(name.casefold().replace("_", " ").split())


def guess_room(location: str, rooms: Iterable[str]) -> str:
    """Return the only room that the name of a location says, empty for none: a bedside table is in the bedroom."""
    words = location.casefold().replace("_", " ").split()
    said = f" {' '.join(words)} "
    whole = [room for room in rooms if f" {' '.join(room.casefold().split())} " in said]
    if whole:
        longest = max(whole, key=len)
        return longest if all(room in longest for room in whole) else ""
    begun = []
    for room in rooms:
        stem = room.casefold().split()[0].removesuffix("room") if room.strip() else ""
        if (
            len(stem) > 2
            and stem != room.casefold().strip()
            and any(word.startswith(stem) for word in words)
        ):
            begun.append(room)
    return begun[0] if len(begun) == 1 else ""
