"""No code knows a predicate, a primitive or a class of the worlds and books that ship by its name.

What the core has to know of them stands in data: ``meanings.toml``, the word lists, the books. Names that are words of
programs as well, such as ``name`` and ``count``, are looked for where forms and entities are read: in the language core
and in the parsers. Elsewhere they are fields, columns and events.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from annotations.language.forms import DEFAULT_CLASSES
from annotations.language.plans import AFTER_COMMANDS, ASK, shipped_books

ROOT = Path(__file__).resolve().parents[1]
CODE = ("annotations", "parser_service", "gpsr_site", "clients")
READING_FORMS = ("annotations/language/", "parser_service/parsers/", "parser_service/neural/")
STARTER = ROOT / "annotations" / "starter"
# They are ours, whatever a world has: the question to the operator, and the left side of what ends all commands.
OURS = {ASK, AFTER_COMMANDS, "sequence"}

# Words of programs: fields of rows, kinds of arguments, answers of people, types of JSON.
WORDS_OF_PROGRAMS = {
    *("name", "object", "category", "question", "location", "room", "gender", "person", "place"),
    *("answer", "count", "open", "close", "at", "take", "wait", "behind", "gesture"),
    *("male", "female"),
}
# Files that may name classes or words like them, and why.
ALLOWED = {
    "annotations/language/forms/symbols.py": "wildcards of GPSRCmdGen, which its grammars are written in",
    "annotations/language/forms/meanings.py": "kinds of meanings in meanings.toml",
    "annotations/language/forms/entity_classes.py": "the class of people, whose names have no plural",
    "annotations/language/forms/slot_places.py": "groups of a regular expression",
    "annotations/language/forms/foreign_forms.py": "groups of a regular expression",
    "annotations/language/forms/logic.py": "signs of a notation",
    "annotations/language/grammar/productions.py": "headings of GPSRCmdGen's files, signs of a notation",
    "annotations/language/grounding/drawing.py": "wildcards of GPSRCmdGen",
    "annotations/language/grounding/grounding.py": "a gender of the entity files",
    "annotations/language/grounding/questions.py": "keys of JSON",
    "annotations/language/induction/offers.py": "English prepositions",
    "annotations/language/corpus/names.py": "attributes of the entity files",
    "annotations/language/corpus/crowd.py": "groups of a regular expression",
    "annotations/language/corpus/rewrite_requests.py": "groups of a regular expression",
    "annotations/language/templates/completion.py": "wildcards of GPSRCmdGen",
    "annotations/language/templates/left_out.py": "the English of a hint",
    "annotations/language/world/competition_folder.py": "the files of a competition's folder",
    "annotations/language/world/ontology_checks.py": "attributes of the entity files",
    "annotations/language/world/ontology_files.py": "the XML files of GPSRCmdGen",
    "annotations/language/world/published_generators.py": "the files of a competition's folder",
    "annotations/language/world/entities.py": "attributes of the entity files",
    "annotations/language/world/gloss_patterns.py": "groups of a regular expression",
    "annotations/language/world/glossing.py": "nouns and kinds of what is said",
    "annotations/language/plans/behavior_tree.py": "attributes of BehaviorTree.CPP's XML",
    "annotations/language/plans/joint_plans.py": "JSON Schema, the unit of a walk",
    "annotations/language/plans/plan.py": "keys of JSON",
    "annotations/language/plans/planning.py": "kinds of arguments in arguments.toml",
    "annotations/language/plans/reading.py": "words and groups of the notation of recipes",
    "annotations/language/plans/rows.py": "words of the notation of recipes",
    "annotations/language/plans/speaking.py": "groups of a regular expression, keys of its own",
    "annotations/language/plans/task_plan.py": "keys of JSON",
    "annotations/language/plans/values.py": "kinds of arguments in recipes",
    "parser_service/parsers/oracle.py": "fields of a parser's file",
    "parser_service/parsers/model_server/protocol.py": "fields of a protocol",
    "parser_service/parsers/llm/chat_messages.py": "JSON Schema",
    "parser_service/parsers/hyperparameters/ranker.py": "names of its settings",
    "parser_service/neural/ranker/fitting.py": "names of its settings",
    "parser_service/neural/ranker/slots.py": "features of a trained model",
}
# What else a file may name, for the reason that it has above.
ALSO_ALLOWED = {
    "annotations/language/world/ontology_files.py": {"whattosay"},
}


def names_of_worlds() -> set[str]:
    names = {each.token for each in DEFAULT_CLASSES}
    for path in STARTER.glob("*/predicates.json"):
        names |= {row["name"] for row in json.loads(path.read_text(encoding="utf-8"))}
    for shipped in shipped_books().values():
        names |= {each.name for each in shipped.book.primitives}
        names |= {each.pattern.action for each in shipped.book.recipes}
    return names - OURS


def literals(tree: ast.AST) -> Iterator[ast.Constant]:
    """Yield texts of code: no docstrings, and no names of attributes of entities."""
    left_out = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr):
            left_out.add(id(node.value))
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            of_attributes = ast.unparse(node.func).endswith((".attribute", "attributes.get"))
            left_out |= {id(each) for each in node.args} if of_attributes else set()
    for node in ast.walk(tree):
        is_text = isinstance(node, ast.Constant) and isinstance(node.value, str)
        if is_text and id(node) not in left_out:
            yield node


def found_in(path: Path, names: set[str]) -> list[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [
        f"{path.relative_to(ROOT)}:{each.lineno} {each.value}"
        for each in literals(tree)
        if str(each.value).strip("<> ") in names
    ]


FILES = [
    path
    for folder in CODE
    for path in sorted((ROOT / folder).rglob("*.py"))
    if "migrations" not in path.parts
]


def test_no_code_knows_a_predicate_or_a_primitive_by_its_name():
    names = names_of_worlds()
    assert len(names) > 60 and {"bring", "is_a", "go_to", "MoveTo", "whattosay"} <= names
    found = []
    for path in FILES:
        place = str(path.relative_to(ROOT))
        is_read_here = place.startswith(READING_FORMS) and place not in ALLOWED
        looked_for = names if is_read_here else names - WORDS_OF_PROGRAMS
        found += found_in(path, looked_for - ALSO_ALLOWED.get(place, set()))
    assert not found


@pytest.mark.parametrize("name", ALLOWED)
def test_a_file_that_may_name_them_does(name):
    assert found_in(ROOT / name, names_of_worlds())
