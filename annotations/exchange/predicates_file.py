"""``predicates.json``: declared predicates beside a generator, read and written.

docs/reference/formats.md, Predicates, describes it. A gloss is a pattern of
``annotations.language.world.gloss_patterns``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from typing import Any

from annotations.language.forms import DEFAULT_CLASSES, EntityClasses
from annotations.language.texts import (
    MAX_GLOSS,
    MAX_PREDICATE,
    LanguageError,
    Position,
    Problem,
    normalise_line,
    read_text,
    require_length,
    require_name,
    require_writable,
)
from annotations.language.world import Predicate, PredicateKind, Signature, known_kinds

PREDICATES_FILE = "predicates.json"
_BETWEEN_ROWS = re.compile(r"[\s,]*+")
_EXAMPLE = '[{"name": "go", "kind": "action", "signatures": [["room"]], "gloss": "go to {1}"}]'


def read_predicates(
    data: bytes,
    source: str = PREDICATES_FILE,
    problems: list[Problem] | None = None,
    classes: EntityClasses = DEFAULT_CLASSES,
) -> dict[str, Predicate]:
    """Return the predicates that a file declares, by name.

    Args:
        problems: where the errors of single rows go; the first one is raised without it.
        classes: those that arguments may be of.

    Raises:
        LanguageError: with the position, where the file is no such list or a value is unknown.
    """
    text, _ = read_text(data, source)
    try:
        rows = json.loads(text)
    except RecursionError:
        raise LanguageError("the file nests too deep", Position(source), _EXAMPLE) from None
    except json.JSONDecodeError as error:
        place = Position(source, error.lineno, error.colno)
        raise LanguageError(f"this is not JSON: {error.msg}", place, _EXAMPLE) from error
    except ValueError as error:  # a number of more digits than Python reads
        raise LanguageError("a number has too many digits", Position(source), _EXAMPLE) from error
    if not isinstance(rows, list):
        raise LanguageError("this is not a list of predicates", Position(source), _EXAMPLE)
    predicates: dict[str, Predicate] = {}
    for row, place in _rows_with_places(text, source):
        try:
            predicate = _predicate(row, place, classes)
            if predicate.name in predicates:
                raise LanguageError(f"{predicate.name} is declared twice", place, "merge the two")
        except LanguageError as error:
            if problems is None:
                raise
            problems.append(error.problem)
        else:
            predicates[predicate.name] = predicate
    return predicates


def write_predicates(predicates: Iterable[Predicate]) -> str:
    """Return the file that reads back as equal predicates, one a line."""
    rows = [
        {
            "name": predicate.name,
            "kind": str(predicate.kind),
            "signatures": [list(map(str, each.arguments)) for each in predicate.signatures],
            "gloss": predicate.gloss,
        }
        for predicate in predicates
    ]
    return "[\n  " + ",\n  ".join(json.dumps(row, ensure_ascii=False) for row in rows) + "\n]\n"


def _predicate(row: Any, place: Position, classes: EntityClasses) -> Predicate:
    if not (isinstance(row, dict) and isinstance(row.get("name"), str) and row["name"]):
        raise LanguageError("this row has no name", place, _EXAMPLE)
    row = {**row, "name": normalise_line(row["name"])}  # JSON may write a character as an escape
    gloss = normalise_line(str(row.get("gloss", "")))
    require_name(row["name"], "predicate", MAX_PREDICATE, place)
    require_writable(row["name"], place)
    require_length(gloss, "gloss", MAX_GLOSS, place)
    require_writable(gloss, place)
    signatures = row.get("signatures")
    if not isinstance(signatures, list) or not all(isinstance(each, list) for each in signatures):
        raise LanguageError(
            f"the signatures of {row['name']} are no list of lists", place, _EXAMPLE
        )
    kind, kinds = row.get("kind", ""), known_kinds(classes)
    are_known = all(argument in kinds for each in signatures for argument in each)
    if kind not in set(PredicateKind) or not are_known:
        raise LanguageError(
            f"{row['name']} has a kind, or arguments of a kind, that there is not",
            place,
            f"a predicate is an action or a description; kinds of arguments are {', '.join(kinds)}",
        )
    read = tuple(Signature(tuple(map(str, each))) for each in signatures)
    return Predicate(row["name"], PredicateKind(kind), read, gloss)


def _rows_with_places(text: str, source: str) -> Iterator[tuple[Any, Position]]:
    """Yield the rows of a list in JSON, each with the line of its name, as JSON keeps no positions."""
    decoder, end = json.JSONDecoder(), text.index("[") + 1
    line, counted = 1, 0
    while gap := _BETWEEN_ROWS.match(text, end):  # always: it may be empty
        begin = gap.end()
        if text[begin] == "]":
            return
        row, end = decoder.raw_decode(text, begin)
        name = row.get("name") if isinstance(row, dict) else None
        place = max(begin, text.find(f'"{name}"', begin, end)) if isinstance(name, str) else begin
        line += text.count("\n", counted, place)
        counted = place
        yield row, Position(source, line)
