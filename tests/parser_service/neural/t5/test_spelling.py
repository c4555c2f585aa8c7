import pytest
from hypothesis import given

from annotations.language.corpus import read_pairs
from annotations.language.forms import read_form
from parser_service.neural.t5.spelling import read, spell, try_to_spell, words_of
from tests.parser_service.parsers.new_forms.test_short import FORMS


def test_a_leaf_application_is_its_predicate_and_its_arguments():
    form = read_form('( bring ( lambda $1 e ( is_a $1 " <object> " ) ( biggest $1 3 ) ) UNKNOWN )')
    written = "(bring L1 is_a: :$1 :<object> biggest: :$1 :#3 ) ?"
    assert spell(form) == tuple(written.split())


@given(FORMS)
def test_every_form_is_read_back(form):
    assert read(spell(form)) == form


def test_every_published_form_is_read_back(shared_data):
    for folder in ("gen", "para", "gen_logical", "para_logical"):
        for part in ("train", "val"):
            path = shared_data / "walker2019" / folder / f"{part}.txt"
            forms = {record.form for record in read_pairs(path.read_bytes(), part).records}
            assert all(read(spell(form)) == form for form in forms)


@pytest.mark.parametrize(
    "atoms", ["", ")", "go:", "go: :$1 at:", ":<room>", "L1 :<room>", "(go :<room>", "go: :$x"]
)
def test_what_spells_no_form_is_refused(atoms):
    with pytest.raises(ValueError):
        read(atoms.split())


@pytest.mark.parametrize("text", ["go", "", "( go {room} )", "( is_a $1 )"])
def test_what_is_no_whole_form_has_no_spelling(text):
    assert try_to_spell(text) is None


@pytest.mark.parametrize(
    ("atom", "words"),
    [
        ("left_of:", "left of"),
        ("(bring", "bring"),
        (":<room>", "room"),
        ('"the%20end', "the end"),
        (":%3A", "unknown"),
        (")", "end"),
        ("?", "unknown"),
    ],
)
def test_the_english_words_of_an_atom(atom, words):
    assert words_of(atom) == words
