"""A world whose commands are a sample of what its templates make."""

from __future__ import annotations

import pytest

from annotations.campaigns.launching import PromptChoice, draw_prompts
from annotations.exchange.split_manifest import manifest_of
from annotations.generation.coverage import coverage_of
from annotations.generation.freezing import freeze_split
from annotations.generation.generating import generate_pairs, start_generation
from annotations.generation.grounded_pairs import grounded_pairs
from annotations.generation.language_size import language_size
from annotations.generation.template_check import check_template
from annotations.generation.uncovered import uncovered_of
from annotations.generation.up_to_date import bring_up_to_date
from annotations.language.templates import DEFAULT_LIMIT, EVERYTHING, Balance, SampleRequest
from annotations.models import Job, TaskCategory, World

TWO = SampleRequest(2, 7)


def texts(world):
    return list(world.commands.order_by("position").values_list("anonymized_text", flat=True))


def again(world):
    return World.objects.get(pk=world.pk)


@pytest.fixture
def sampled(tiny_world) -> World:
    """Two of the three commands of the tiny world."""
    generate_pairs(tiny_world, request=TWO)
    return again(tiny_world)


@pytest.fixture
def large(tiny_world) -> World:
    """A world with more commands than anybody would make, and 40 of them."""
    grammar = tiny_world.grammar
    digits = " | ".join(f"w{number}" for number in range(10))
    source = grammar.productions.filter(nonterminal="Main")[0].source
    grammar.productions.create(
        nonterminal="digit", expansion=digits, source=source, line=90, position=90
    )
    template = grammar.templates.get(pattern__startswith="go")
    template.pattern += " $digit" * 12
    template.save()
    tiny_world.mark_changed()
    generate_pairs(again(tiny_world), request=SampleRequest(40))
    return again(tiny_world)


def too_large(world):
    """What is said of templates that make too many commands."""
    said = (each["message"] for row in world.grammar.templates.all() for each in row.problems)
    return [message for message in said if f"{DEFAULT_LIMIT:,}" in message]


def test_a_template_of_many_commands_is_left_out_of_all_of_them_and_not_of_a_sample(large):
    assert too_large(large) == []
    generate_pairs(large, request=EVERYTHING)
    assert len(too_large(large)) == 1
    generate_pairs(large, request=TWO)
    assert too_large(large) == []


def test_what_a_template_makes_is_counted_as_it_is_typed_unless_commands_are_drawn(large):
    row = large.grammar.templates.get(pattern__startswith="go")
    category = TaskCategory.objects.get(name=row.task_category)
    drawn = check_template(large, category, row.pattern, row.form).problems
    large.sample = {}
    problems = check_template(large, category, row.pattern, row.form).problems
    (problem,) = set(problems) - set(drawn)
    assert f"{DEFAULT_LIMIT:,}" in problem.message


def test_a_world_remembers_what_sample_it_has(sampled):
    note = sampled.sample_note
    assert note is not None
    assert (note.commands, note.of, note.request) == (2, 3, TWO)
    assert sampled.sample_request == TWO
    assert len(texts(sampled)) == 2
    assert not sampled.commands_are_stale


def test_the_same_seed_gives_the_same_rows(sampled):
    rows = list(sampled.commands.order_by("pk").values())
    assert generate_pairs(sampled, request=TWO).changes.is_none
    assert generate_pairs(sampled).changes.is_none  # as the last time
    assert list(sampled.commands.order_by("pk").values()) == rows


def test_all_commands_come_when_they_are_asked_for(sampled):
    report = generate_pairs(sampled, request=EVERYTHING)
    assert report.sample is None
    assert again(sampled).sample == {}
    assert len(texts(sampled)) == 3


def test_a_sample_of_all_commands_is_not_called_a_sample(tiny_world):
    generate_pairs(tiny_world, request=SampleRequest(10, balance=Balance.FORMS))
    world = again(tiny_world)
    assert world.sample_note is None
    assert world.sample_request.size == 10
    assert TaskCategory.objects.get(grammar__world=world).commands_with_form == 3


def test_a_change_draws_the_sample_anew(sampled):
    row = sampled.grammar.templates.get(pattern__startswith="go")
    row.form = "(visit {room})"
    row.save()
    sampled.mark_changed()
    assert bring_up_to_date(sampled).is_up_to_date
    world = again(sampled)
    assert world.sample_request == TWO
    assert len(texts(world)) == 2


@pytest.mark.parametrize("request_", [None, SampleRequest(1, 4, Balance.LINES)])
def test_commands_of_a_large_language_wait_for_one_job(request_, sampled, annotator, monkeypatch):
    monkeypatch.setattr("annotations.generation.language_size.MOST_COMMANDS", 2)
    first, second = (start_generation(sampled, annotator, request_) for _ in range(2))
    assert isinstance(first, Job) and first == second
    wanted = {"sample": 1, "seed": 4, "balanced": "lines"} if request_ else {}
    assert first.arguments == wanted
    other = start_generation(sampled, annotator, SampleRequest(1, 5, Balance.LINES))
    assert isinstance(other, Job) and other != first


def test_commands_outside_a_sample_are_not_said_to_have_no_form(sampled):
    category = TaskCategory.objects.get(grammar__world=sampled)
    assert (category.commands_in_grammar, category.commands_with_form) == (None, None)
    (coverage,) = coverage_of(sampled)
    assert (coverage.size, coverage.commands, coverage.covered) == (3, None, None)
    report = uncovered_of(sampled)
    assert (report.commands, len(report.problems)) == ((), 1)


def test_a_split_and_its_manifest_say_what_sample_they_are_of(sampled):
    split = freeze_split(sampled, "small")
    assert split.sample_note == sampled.sample_note
    assert manifest_of(split)["sample"] == sampled.sample
    generate_pairs(sampled, request=EVERYTHING)
    whole = freeze_split(again(sampled), "whole")
    assert manifest_of(whole)["sample"] is None
    split.refresh_from_db()
    assert split.sample_note is not None


def test_a_large_world_says_its_size_and_draws_from_it(large):
    assert language_size(large) == 10**12 + 2
    assert len(texts(large)) == 40
    assert large.sample_note is not None
    assert large.sample_note.of == 10**12 + 2


def test_a_sample_of_a_large_world_is_grounded(large):
    pairs = grounded_pairs(large, 60, seed=2)
    assert len(pairs) == 60
    assert {text.split()[3] for text, _ in pairs if text.startswith("go")} == {"kitchen", "bath"}
    assert pairs == grounded_pairs(large, 60, seed=2)


def test_a_campaign_asks_for_commands_of_the_sample(large):
    prompts = draw_prompts(large, PromptChoice(prompts_per_form=5))
    assert prompts
    assert {each.expansion.command for each in prompts} <= set(texts(large))
