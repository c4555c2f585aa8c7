"""Lines for nonterminals are templates: everything that happens to templates happens to them."""

from __future__ import annotations

import pytest
from django.urls import reverse

from annotations.editing.edits import change
from annotations.exchange.generator_export import generator_files
from annotations.exchange.generator_import import import_generator
from annotations.generation.generating import generate_pairs
from annotations.generation.production_check import ProductionEdit, check_production
from annotations.generation.template_check import check_template
from annotations.generation.world_consequences import consequences
from annotations.models import SemanticTemplate, TaskCategory, World
from annotations.models.description import TemplateStatus
from annotations.web.description.template_forms import change_to
from tests.annotations.conftest import as_bytes
from tests.annotations.generation.test_up_to_date import commands_of

FILES = {
    "g_grammar.txt": (
        "$Main = $goto and $do | $goto\n$goto = go to the {room}\n"
        "$do = put it on the {placement} | wave\n"
    ),
    "g_semantics.txt": (
        "$goto and $do = (sequence $goto $do)\n$goto = $goto\n"
        "$goto -> go to the {room 1} = (go {room 1})\n"
        "$do -> put it on the {placement} = (put it {placement})\n"
    ),
    "locations.xml": '<rooms><room name="kitchen"><location name="sink" isPlacement="true"/>'
    '<location name="shelf" isPlacement="true"/></room></rooms>',
}
COMPOSED = "go to the <room> and put it on the <location>"


@pytest.fixture
def composed(world) -> World:
    assert not import_generator(world.name, as_bytes(FILES)).is_refused
    generate_pairs(world)
    return world


def line_of(world, start):
    return SemanticTemplate.objects.get(grammar__world=world, pattern__startswith=start)


def test_commands_of_composed_templates_are_generated_and_the_rest_is_uncovered(composed):
    assert commands_of(composed) == {
        COMPOSED: '( sequence ( go " <room> " ) ( put it " <location> " ) )',
        "go to the <room>": '( go " <room> " )',
    }
    category = TaskCategory.objects.get(grammar__world=composed)
    assert (category.commands_in_grammar, category.commands_with_form) == (3, 2)


def test_a_changed_line_changes_the_commands_that_took_it_as_was_said(composed, annotator):
    row = line_of(composed, "$do ->")
    category = TaskCategory.objects.get(grammar__world=composed)
    new = {"pattern": row.pattern, "form": "(place it {placement})", "status": TemplateStatus.READY}
    expected = consequences(composed, change_to(row, category, new))
    assert [each.command for each in expected.changes.changed] == [COMPOSED]
    change(row, {"form": new["form"]}, annotator, row.version)
    assert commands_of(composed)[COMPOSED] == expected.changes.changed[0].after


def test_export_gives_the_lines_back(composed, world):
    files = generator_files(composed)
    written = next(text for name, text in files.items() if name.endswith("g_semantics.txt"))
    text = written if isinstance(written, str) else written.decode()
    assert "$do -> put it on the {placement} = (put it {placement})" in text


def test_a_line_is_checked_as_it_is_typed(composed):
    category = TaskCategory.objects.get(grammar__world=composed)
    checked = check_template(composed, category, "$do -> wave", "(wave)")
    assert not checked.has_errors and checked.commands == (("wave", "( wave )"),)
    cyclic = check_template(composed, category, "$do -> wave and $do", "(sequence (wave) $do)")
    assert cyclic.has_errors


def test_the_page_of_a_template_shows_a_line(composed, anna):
    row = line_of(composed, "$do ->")
    page = anna.get(reverse("template", args=[composed, row.pk]))
    assert page.status_code == 200 and "$do" in page.content.decode()


def test_a_production_that_closes_a_cycle_through_a_line_is_an_error(composed):
    line = line_of(composed, "$do ->")
    edit = ProductionEdit(composed, "g_grammar.txt", "more", "it")
    assert not check_production(edit).has_errors
    SemanticTemplate.objects.filter(pk=line.pk).update(pattern="$do -> then $more")
    assert check_production(ProductionEdit(composed, "g_grammar.txt", "more", "$do")).has_errors
