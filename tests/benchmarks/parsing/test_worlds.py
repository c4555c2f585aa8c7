import pytest

from benchmarks.parsing.worlds import WORLDS, made_up


@pytest.mark.parametrize("name", [name for name in WORLDS if name != "200000 commands"])
def test_a_made_up_world_has_as_many_forms_and_pairs_as_it_says(name):
    forms, pairs, source = WORLDS[name]
    made = made_up(forms, pairs, source)
    assert len(made) == len({pair.utterance for pair in made}) == pairs
    assert len({pair.form for pair in made}) == forms
