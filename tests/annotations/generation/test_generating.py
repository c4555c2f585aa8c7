from __future__ import annotations

import pytest

from annotations.exchange.generator_import import import_generator
from annotations.generation.complexity import complexity
from annotations.generation.generating import generate_pairs
from annotations.language.texts.errors import LanguageError
from annotations.models import Command, LogicalForm, World
from annotations.models.description import ProblemSubject
from tests.annotations.rows_of import rows_of
from tests.sample_world import make_paraphrase


@pytest.fixture
def gpsr2018(db, shared_data):
    import_generator("gpsr2018", shared_data / "generator-2018")
    return World.objects.get(name="gpsr2018")


def test_2018_gives_the_published_commands_and_forms(gpsr2018):
    figures = generate_pairs(gpsr2018).as_json()
    assert figures["commands"] == {"1": 192, "2": 352, "3": 667, "all": 1211}
    assert figures["forms"] == {"1": 17, "2": 39, "3": 45, "all": 101}
    assert figures["outside_grammar"] == 45
    assert [each["task_category"] for each in figures["conflicts"]] == ["2"] * 3 + ["3"] * 5
    assert figures["unmatched_templates"] == ["gpsr_category_2_semantics.txt:10:1"]


def test_2018_has_the_published_complexity(gpsr2018):
    generate_pairs(gpsr2018)
    columns = complexity(gpsr2018)
    assert [each.task_category for each in columns] == ["1", "2", "3", ""]
    assert [round(each.mean_command_length, 2) for each in columns] == [11.92, 11.96, 10.40, 11.09]
    assert [round(each.mean_form_length, 2) for each in columns] == [28.35, 26.97, 22.58, 25.25]
    assert [round(each.commands_per_form, 1) for each in columns] == [11.3, 9.0, 14.8, 12.0]


@pytest.mark.parametrize("folder", ["gen", "gen_logical"])
@pytest.mark.parametrize("part", ["train", "val"])
def test_every_published_pair_is_generated_with_its_form(gpsr2018, shared_data, folder, part):
    generate_pairs(gpsr2018)
    ours = dict(gpsr2018.commands.values_list("anonymized_text", "logical_form__text"))
    text = (shared_data / "walker2019" / folder / f"{part}.txt").read_text(encoding="utf-8")
    lines = text.splitlines()
    for command, form in zip(lines[::2], lines[1::2], strict=True):
        assert ours[command] == form


def test_a_second_generation_changes_no_row(gpsr2018):
    generate_pairs(gpsr2018)
    before = rows_of(gpsr2018)
    report = generate_pairs(gpsr2018)
    assert rows_of(gpsr2018) == before
    assert report.changes.as_json() == {"added": 0, "changed": 0, "removed": 0, "moved": 0}


def test_commands_know_their_template_form_and_category(tiny_world):
    generate_pairs(tiny_world)
    command = tiny_world.commands.get(anonymized_text="locate the <object>")
    assert command.template.pattern == "$vbfind the $object"
    assert command.logical_form.text == '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'
    assert (command.logical_form.head_predicate, command.logical_form.depth) == ("find", 3)
    assert (command.length, command.task_category, command.is_in_grammar) == (3, "1", True)


def test_a_changed_template_changes_only_its_commands(tiny_world, tiny):
    generate_pairs(tiny_world)
    kept = set(tiny_world.commands.filter(anonymized_text__contains="<object>"))
    tiny["tiny_category_1_semantics.txt"] = tiny["tiny_category_1_semantics.txt"].replace(
        b"(go {room})", b"(visit {room})"
    )
    import_generator(tiny_world.name, tiny)
    report = generate_pairs(tiny_world)
    assert set(tiny_world.commands.filter(anonymized_text__contains="<object>")) == kept
    command = tiny_world.commands.get(anonymized_text="go to the <room>")
    assert command.logical_form.text == '( visit " <room> " )'
    assert report.changes.as_json() == {"added": 1, "changed": 1, "removed": 1, "moved": 0}


def test_a_command_that_no_template_makes_goes_and_its_paraphrases_stay(tiny_world):
    generate_pairs(tiny_world)
    said = make_paraphrase(
        tiny_world,
        command=tiny_world.commands.get(anonymized_text="go to the <room>"),
        prompt="go to the bath",
        utterance="drive to the bath",
        grounded_form='( go " bath " )',
        logical_form='( go " <room> " )',
    )
    tiny_world.grammar.templates.filter(pattern__startswith="go").delete()
    generate_pairs(tiny_world)
    said.refresh_from_db()
    assert said.command is None
    assert not Command.objects.filter(anonymized_text="go to the <room>").exists()
    assert not LogicalForm.objects.filter(head_predicate="go").exists()


def test_a_conflict_is_stored_with_both_places(tiny_world, tiny):
    tiny["tiny_category_1_semantics.txt"] += b"go to the {room} = (visit {room})\n"
    import_generator(tiny_world.name, tiny)
    generate_pairs(tiny_world)
    problem = tiny_world.problems.get(subject=ProblemSubject.COMMANDS)
    assert problem.line == 4
    assert "( visit " in problem.message
    assert "tiny_category_1_semantics.txt:3:1" in problem.message


def test_more_commands_than_the_limit_are_refused_with_their_number(tiny_world):
    generate_pairs(tiny_world)
    before = rows_of(tiny_world)
    with pytest.raises(LanguageError, match=r"\b2\b"):
        generate_pairs(tiny_world, limit=2)
    assert rows_of(tiny_world) == before


def test_a_world_without_a_grammar_generates_nothing(world):
    assert generate_pairs(world).as_json()["commands"] == {"all": 0}


def test_generation_and_import_count_what_has_a_form(tiny_world):
    category = tiny_world.grammar.task_categories.get()
    assert (category.commands_in_grammar, category.commands_with_form) == (3, 0)
    generate_pairs(tiny_world)
    category.refresh_from_db()
    assert (category.commands_in_grammar, category.commands_with_form) == (3, 3)
    tiny_world.grammar.templates.first().delete()
    generate_pairs(tiny_world)
    category.refresh_from_db()
    assert category.commands_without_form == 2
    assert category.covered_percent == pytest.approx(100 / 3)
