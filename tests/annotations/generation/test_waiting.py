"""How many commands wait for the first generation, and what they will cover."""

from __future__ import annotations

import pytest

from annotations.exchange.generator_import import import_generator
from annotations.generation import waiting
from annotations.generation.generating import generate_pairs
from annotations.generation.waiting import waiting_commands
from annotations.language.texts.errors import LanguageError
from annotations.models import World
from tests.annotations.conftest import TINY, as_bytes


@pytest.fixture
def imported(db) -> World:
    files = TINY | {
        # One command outside the grammar, and one of the grammar without a template.
        "tiny_category_1_semantics.txt": (
            "$vbfind the $object = (find (λ$1:e (is_a $1 $object)))\nwave = (wave)\n"
        ),
    }
    assert not import_generator("home", as_bytes(files)).is_refused
    return World.objects.get(name="home")


def test_what_is_counted_is_what_the_generation_makes(imported):
    counted = waiting_commands(imported)
    assert (counted.count, counted.said, counted.is_estimate) == (3, "3", False)
    assert (counted.with_form, counted.in_grammar) == (2, 3)
    stored = imported.grammar.task_categories.get()
    assert stored.commands_with_form == 0
    generate_pairs(imported)
    stored.refresh_from_db()
    assert imported.commands.count() == counted.count
    assert (stored.commands_with_form, stored.commands_in_grammar) == (2, 3)
    imported.refresh_from_db()
    assert waiting_commands(imported) is None


def test_of_a_large_language_only_the_size_is_told(imported, monkeypatch, client, superuser):
    def refuse(categories):
        raise LanguageError("too many")

    monkeypatch.setattr(waiting, "generate_at_once", refuse)
    counted = waiting_commands(imported)
    assert counted.is_estimate and counted.count >= 3 and not counted.coverage
    monkeypatch.setattr(waiting, "language_size", lambda world: 2_300_000)
    client.force_login(superuser)
    page = " ".join(client.get("/w/home/commands/").content.decode().split())
    assert "<strong>Up to" in page and "Of so many a sample is drawn." in page
    assert 'action="/w/home/generate/"' not in page
    assert 'class="primary" href="/w/home/generation/">Generate commands' in page


def test_a_world_without_templates_waits_for_nothing(db):
    assert waiting_commands(World.objects.create(name="empty")) is None


def test_where_a_grammar_was_not_counted_nothing_is_said_of_it(imported):
    imported.grammar.task_categories.update(commands_in_grammar=None)
    counted = waiting_commands(imported)
    assert (counted.count, counted.in_grammar) == (3, 0)


def test_drafts_wait_for_nothing(imported):
    imported.grammar.templates.update(status="draft")
    assert waiting_commands(imported) is None
