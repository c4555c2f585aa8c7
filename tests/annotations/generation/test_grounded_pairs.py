from __future__ import annotations

import pytest

from annotations.generation.grounded_pairs import grounded_pairs
from annotations.language.texts.errors import LanguageError
from annotations.models import Entity


def test_grounded_pairs_name_things_of_the_world(tiny_world):
    pairs = grounded_pairs(tiny_world, 30, seed=1)
    assert len(pairs) == 30
    assert set(pairs) == {
        ("find the tea", '( find ( lambda $1 e ( is_a $1 " tea " ) ) )'),
        ("locate the tea", '( find ( lambda $1 e ( is_a $1 " tea " ) ) )'),
        ("go to the kitchen", '( go " kitchen " )'),
        ("go to the bath", '( go " bath " )'),
    }


def test_each_command_has_its_turn_before_one_comes_again(tiny_world):
    first_words = [text.split()[0] for text, _ in grounded_pairs(tiny_world, 3)]
    assert sorted(first_words) == ["find", "go", "locate"]


def test_a_seed_decides(tiny_world):
    assert grounded_pairs(tiny_world, 20, seed=5) == grounded_pairs(tiny_world, 20, seed=5)
    assert grounded_pairs(tiny_world, 20, seed=5) != grounded_pairs(tiny_world, 20, seed=6)


def test_a_command_that_the_ontology_cannot_ground_is_left_out(tiny_world):
    Entity.objects.filter(entity_class="room").delete()
    assert not any("go" in text for text, _ in grounded_pairs(tiny_world, 10))


def test_a_world_that_can_ground_nothing_says_so(tiny_world):
    Entity.objects.all().delete()
    with pytest.raises(LanguageError):
        grounded_pairs(tiny_world, 1)


def test_a_world_without_templates_says_so(world):
    with pytest.raises(LanguageError):
        grounded_pairs(world, 1)
