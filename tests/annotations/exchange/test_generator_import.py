"""What an import stores, changes, removes and refuses."""

from __future__ import annotations

import json

import pytest

from annotations.exchange.generator_import import import_generator
from annotations.exchange.predicates_file import read_predicates
from annotations.generation.generating import generate_pairs
from annotations.language.world import ArgumentKind
from annotations.models import SemanticTemplate, World
from annotations.models.description import ProblemSubject, TemplateStatus
from annotations.models.worlds import Duty
from annotations.rows.from_rows import predicates_of, task_categories
from tests.annotations.rows_of import counts, rows_of
from tests.timing import least_seconds


def test_an_error_anywhere_refuses_the_whole_import(tiny_world, tiny):
    before = counts(), rows_of(tiny_world)
    tiny["common_rules.txt"] += b"$new = a word\n"
    tiny["tiny_category_1_semantics.txt"] += b"go to the {room} = (go {beacon})\n"
    report = import_generator(tiny_world.name, tiny)
    assert report.is_refused
    assert (counts(), rows_of(tiny_world)) == before


def test_an_error_leaves_no_world_behind(db, tiny):
    tiny["names.xml"] = b""
    assert import_generator("new", tiny).is_refused
    assert not World.objects.exists()


def test_changed_files_change_only_what_differs(tiny_world, tiny):
    before = {row.pattern: row for row in tiny_world.grammar.templates.all()}
    tiny["tiny_category_1_semantics.txt"] = (
        "$vbfind a $object = (find (λ$1:e (is_a $1 $object)))\n"
        "go to the {room} = (go {room})\n"
        "$vbfind the $object = (find (λ$1:e (is_a $1 $object)))\n"
    ).encode()
    report = import_generator(tiny_world.name, tiny)
    after = {row.pattern: row for row in tiny_world.grammar.templates.all()}
    assert [after[row.pattern].position for row in after.values()] == [0, 1, 2]
    assert list(after) == ["$vbfind a $object", "go to the {room}", "$vbfind the $object"]
    assert {after[pattern].pk for pattern in before} == {row.pk for row in before.values()}
    assert report.changes.removed == 0


def test_a_new_line_above_moves_the_others_and_changes_none(tiny_world, tiny):
    file = "tiny_category_1_semantics.txt"
    tiny[file] = b"visit the {room} = (go {room})\n" + tiny[file]
    changes = import_generator(tiny_world.name, tiny).changes
    assert (changes.added, changes.changed, changes.moved) == (1, 0, 2)


def test_an_import_that_changes_templates_leaves_commands_out_of_date(tiny_world, tiny):
    generate_pairs(tiny_world)
    tiny_world.refresh_from_db()
    assert not tiny_world.commands_are_stale
    import_generator(tiny_world.name, tiny)
    tiny_world.refresh_from_db()
    assert not tiny_world.commands_are_stale
    tiny["tiny_category_1_semantics.txt"] += b"visit the {room} = (go {room})\n"
    import_generator(tiny_world.name, tiny)
    tiny_world.refresh_from_db()
    assert tiny_world.commands_are_stale


def test_rows_that_the_files_no_longer_have_go(tiny_world, tiny):
    tiny["locations.xml"] = b'<rooms><room name="kitchen"/></rooms>'
    import_generator(tiny_world.name, tiny)
    texts = tiny_world.ontology.entities.values_list("text", flat=True)
    assert list(texts) == ["drinks", "tea", "milk", "kitchen"]


def test_drafts_and_templates_of_people_stay_behind_those_of_the_files(tiny_world, tiny, annotator):
    grammar = tiny_world.grammar
    common = {"grammar": grammar, "source": "tiny_category_1_semantics.txt", "form": "(go {room})"}
    draft = SemanticTemplate.objects.create(
        **common, pattern="drive to the {room}", status=TemplateStatus.DRAFT, position=2
    )
    written = SemanticTemplate.objects.create(
        **common, pattern="walk to the {room}", author=annotator, position=3
    )
    tiny["tiny_category_1_semantics.txt"] += b"visit the {room} = (go {room})\n"
    import_generator(tiny_world.name, tiny)
    order = [row.pk for row in grammar.templates.all()][-2:]
    assert order == [draft.pk, written.pk]
    ready = {template.pattern_text for template in task_categories(tiny_world)[0].templates}
    assert "walk to the {room}" in ready
    assert "drive to the {room}" not in ready


def test_a_line_that_a_person_has_corrected_is_not_brought_back(tiny_world, tiny, annotator):
    row = tiny_world.grammar.templates.get(pattern="go to the {room}")
    row.form, row.author, row.version = "(visit {room})", annotator, 2
    row.save()
    before = rows_of(tiny_world)["SemanticTemplate"]
    import_generator(tiny_world.name, tiny)
    assert rows_of(tiny_world)["SemanticTemplate"] == before


def test_signatures_are_inferred_from_what_the_forms_become(tiny_world):
    is_a = predicates_of(tiny_world)["is_a"]
    assert is_a.signatures[0].arguments == (ArgumentKind.VARIABLE, "object")


def test_an_edited_predicate_survives_an_import_and_a_mismatch_is_a_warning(tiny_world, tiny):
    tiny_world.predicates.filter(name="go").update(
        signatures=[["location"]], gloss="drive to {1}", is_edited=True
    )
    report = import_generator(tiny_world.name, tiny)
    assert tiny_world.predicates.get(name="go").gloss == "drive to {1}"
    problem = tiny_world.problems.get(subject=ProblemSubject.TEMPLATES)
    assert "argument 1 of go" in problem.message
    assert (problem.source, problem.line) == ("tiny_category_1_semantics.txt", 3)
    assert not report.is_refused


def test_declared_predicates_are_taken_from_their_file(db, tiny):
    tiny["predicates.json"] = (
        b'[{"name": "go", "kind": "action", "signatures": [["room"]], "gloss": "go to {1}"}]'
    )
    report = import_generator("declared", tiny)
    world = World.objects.get(name="declared")
    assert list(world.predicates.values_list("name", "gloss")) == [("go", "go to {1}")]
    assert {problem.message for problem in report.problems} == {
        "there is no predicate find",
        "there is no predicate is_a",
    }


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("[\n{", 2),
        ("{}", 1),
        ('[\n{"kind": "action"}]', 2),
        ('[\n{"name": "go", "kind": "verb", "signatures": []}]', 2),
        ('[\n{"name": "go", "kind": "action", "signatures": [["planet"]]}]', 2),
        ('[\n{"name": "go", "kind": "action", "signatures": "room"}]', 2),
        ("[" * 5000, 1),
        ("[" + "9" * 5000 + "]", 1),
        ('[\n{"name": "' + "p" * 81 + '", "kind": "action", "signatures": []}]', 2),
        ('[\n{"name": "go", "kind": "action", "signatures": [], "gloss": "' + "g" * 201 + '"}]', 2),
        ('[\n{"name": "go", "kind": "action", "signatures": [], "gloss": "a\\u0000b"}]', 2),
        ('[\n{"name": "go", "kind": "action", "signatures": [], "gloss": "a\\ud800b"}]', 2),
    ],
)
def test_a_faulty_predicates_file_is_refused_at_its_line(db, tiny, text, line):
    tiny["predicates.json"] = text.encode()
    (problem,) = import_generator("declared", tiny).errors
    assert (problem.position.source, problem.position.line) == ("predicates.json", line)


def test_reading_predicates_takes_time_in_proportion_to_their_number():
    def seconds(n: int) -> float:
        rows = [{"name": f"p{k}", "kind": "action", "signatures": []} for k in range(n)]
        data = json.dumps(rows, indent=1).encode()
        assert len(read_predicates(data)) == n
        return least_seconds(lambda: read_predicates(data))

    assert seconds(12_000) < 10 * seconds(3_000)


def test_who_imports_a_new_world_is_its_admin(db, tiny, stranger):
    import_generator("new", tiny, by=stranger)
    assert World.objects.get(name="new").allows(stranger, Duty.MANAGE)


def test_a_file_that_no_generator_has_is_a_warning(db, tiny):
    tiny["notes.pdf"] = b"%PDF"
    (problem,) = import_generator("new", tiny).problems
    assert problem.position.source == "notes.pdf" and not problem.is_error


@pytest.mark.parametrize("name", ["Upper", "with space", "", "-dash", "x" * 61])
def test_a_name_that_no_world_can_have_is_refused_with_a_sentence(db, tiny, name):
    (problem,) = import_generator(name, tiny).errors
    assert f"“{name}”" in problem.message and not World.objects.filter(name=name).exists()


def test_an_upload_has_bounds(db, tiny, settings):
    settings.UPLOAD_MAX_FILES = 3
    assert " 3 " in str(import_generator("new", tiny).errors[0])
    settings.UPLOAD_MAX_FILES, settings.UPLOAD_MAX_BYTES = 64, 10
    assert " 10 " in str(import_generator("new", tiny).errors[0])


@pytest.mark.parametrize("name", ["../evil.txt", "a/b.txt", "..\\evil.txt"])
def test_no_path_of_a_file_leaves_its_folder(db, tiny, name):
    tiny[name] = b"$Main = hello\n"
    report = import_generator("new", tiny)
    assert name.replace("\\", "/").rsplit("/", 1)[-1] in report.productions
    assert not any("/" in name or "\\" in name for name in report.productions)


def test_a_grammar_with_an_aliased_import_reads_back_as_it_was(db):
    files = {
        "part.txt": b"$Main = {object} | $Extra\n$Extra = cup\n",
        "whole.txt": b"; import part.txt as $thing\n$Main = take the $thing\n",
    }
    import_generator("alias", files)
    grammars = {
        each.name: each.grammar for each in task_categories(World.objects.get(name="alias"))
    }
    assert list(grammars["whole"].commands()) == ["take the <object>", "take the cup"]
    assert list(grammars["part"].commands()) == ["<object>", "cup"]


def test_ten_to_the_twelfth_expansions_import_at_once(db):
    digits = " | ".join("abcdefghij")
    files = {"huge.txt": f"$Main = {' '.join(['$d'] * 12)}\n$d = {digits}\n".encode()}
    report = import_generator("huge", files)
    assert not report.is_refused
    (category,) = task_categories(World.objects.get(name="huge"))
    assert category.grammar.size() == 10**12


def test_templates_of_a_grammar_too_large_to_enumerate_import_too(db):
    digits = " | ".join("abcdefghij")
    files = {
        "huge.txt": f"$Main = say {' '.join(['$d'] * 12)} $e\n$d = {digits}\n$e = x\n".encode(),
        "huge_semantics.txt": f"say {' '.join(['$d'] * 12)} $e = (say $e)\n".encode(),
    }
    report = import_generator("huge", files)
    assert not report.is_refused and report.predicates == 1


def test_a_template_whose_expansions_nearly_all_disagree_imports_at_once(db):
    digits = " | ".join("abcdefghij")
    line = " ".join(["$d"] * 8)
    files = {
        "huge.txt": f"$Main = say {line}\n$d = {digits}\n".encode(),
        "huge_semantics.txt": f"say {line} = (say $d)\n".encode(),
    }
    assert not import_generator("huge", files).is_refused


def test_two_files_that_would_make_one_task_category_are_refused_with_a_sentence(db):
    files = {"x.txt": b"$Main = hello\n", "x_grammar.txt": b"$Main = hi\n"}
    (problem,) = import_generator("twins", files).errors
    assert " x.txt" in problem.message and problem.position.source == "x_grammar.txt"


def test_what_would_be_removed_is_asked_for_and_nothing_is_stored(tiny_world, tiny):
    before = rows_of(tiny_world)
    del tiny["tiny_category_1_semantics.txt"]
    report = import_generator(tiny_world.name, tiny, may_remove=False)
    assert report.is_waiting
    assert (
        report.removals.templates[1]
        == "tiny_category_1_semantics.txt: go to the {room} = (go {room})"
    )
    assert (report.removals.productions, report.removals.entities) == ((), ())
    assert rows_of(tiny_world) == before


def test_nothing_is_asked_where_nothing_goes(tiny_world, tiny):
    tiny["tiny_category_1_semantics.txt"] += b"visit the {room} = (go {room})\n"
    report = import_generator(tiny_world.name, tiny, may_remove=False)
    assert not report.is_waiting and report.changes.added == 1
