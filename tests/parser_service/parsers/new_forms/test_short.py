import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import read_pairs
from annotations.language.forms import (
    UNKNOWN,
    Application,
    Constant,
    Lambda,
    Reference,
    Variable,
    read_form,
)
from parser_service.parsers.short import lengthen, name_of, shorten

NAMES = st.text('aL:$#?/() "é_', min_size=1, max_size=4).map(lambda name: f"p{name}")
LEAVES = st.one_of(
    st.builds(Variable, st.integers(1, 9)),
    st.builds(Constant, st.integers(0, 99)),
    st.builds(Constant, st.text("L$#?:%/(< >é1", min_size=1).filter(str.strip)),
    st.sampled_from([UNKNOWN, Reference("it"), Reference("them")]),
)


def nested(inner):
    parts = st.lists(inner, max_size=3).map(tuple)
    return st.one_of(
        st.builds(Application, NAMES, parts),
        st.builds(Lambda, st.integers(1, 9), st.sampled_from(["e", "t/1"]), parts),
    )


FORMS = nested(st.recursive(LEAVES, nested, max_leaves=12))


def test_an_application_of_leaves_is_one_token_and_closing_parentheses_are_dropped():
    form = read_form('( bring ( lambda $1 e ( is_a $1 " <object> " ) ( biggest $1 3 ) ) UNKNOWN )')
    assert shorten(form) == ("(bring", "L1", "is_a:$1:<object>", "biggest:$1:#3", ")", "?")


def test_a_whole_form_may_be_one_token():
    assert shorten(read_form('( go " <room> " )')) == ("go:<room>",)
    assert shorten(UNKNOWN) == ("?",)


@given(FORMS)
def test_every_form_is_read_back(form):
    assert lengthen(shorten(form)) == form


def test_every_published_form_is_read_back_from_a_quarter_of_its_tokens(shared_data):
    forms = {
        record.form
        for folder in ("gen", "para", "gen_logical", "para_logical")
        for part in ("train", "val")
        for record in read_pairs(
            (shared_data / "walker2019" / folder / f"{part}.txt").read_bytes(), part
        ).records
    }
    assert all(lengthen(shorten(form)) == form for form in forms)
    assert sum(len(shorten(form)) for form in forms) / len(forms) < 5.8


@pytest.mark.parametrize("tokens", [(), (")",), ("go:<room>", "go:<room>"), ("Lx",), ("go:$x",)])
def test_what_spells_no_form_is_refused(tokens):
    with pytest.raises(ValueError):
        lengthen(tokens)


def test_a_template_has_no_short_spelling():
    with pytest.raises(ValueError, match="room"):
        shorten(read_form("(go {room})"))


@pytest.mark.parametrize(
    ("token", "name"),
    [
        ("(bring", "bring"),
        ("at:$1:<room>", "at"),
        ("L1", ""),
        (")", ""),
        ('"<room>', ""),
        ("?", ""),
    ],
)
def test_the_predicate_of_a_token(token, name):
    assert name_of(token) == name
