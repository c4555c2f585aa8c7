from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.plans import (
    EffectKind,
    read_book,
    read_primitive,
    read_recipe,
    shipped_books,
)
from annotations.language.texts import MAX_ROW, LanguageError, Position

NAMES = st.from_regex(r"[a-z]{2,8}", fullmatch=True).filter(lambda name: name != "operator")


def error_of(read, text: str) -> LanguageError:
    with pytest.raises(LanguageError) as caught:
        read(text, Position("rows", 7, 3))
    assert caught.value.hint
    return caught.value


def test_a_primitive_has_parameters_words_and_effects():
    primitive = read_primitive(
        'place(thing, place?) "put {thing} down | put {thing} on {place}": releases thing at place'
    )
    assert primitive.name == "place"
    assert [(each.name, each.is_optional) for each in primitive.parameters] == [
        ("thing", False),
        ("place", True),
    ]
    assert primitive.said == ("put {thing} down", "put {thing} on {place}")
    effect = primitive.effect(EffectKind.RELEASES)
    assert (effect.subject, effect.preposition, effect.target) == ("thing", "at", "place")


def test_a_recipe_has_an_action_with_kinds_and_the_calls_that_do_it():
    recipe = read_recipe(
        "say(text: answer(question), listener: person) -> go_to(place of listener), "
        'x = ask(question, "a \\" b", operator) say(x)'
    )
    text, listener = recipe.pattern.parameters
    assert text.action.action == "answer" and listener.kind == "person"
    assert recipe.pattern.names() == ("question", "listener")
    assert [call.result for call in recipe.calls] == ["", "x", ""]
    assert recipe.calls[1].arguments[1].text == 'a " b'


@pytest.mark.parametrize("name", shipped_books())
def test_what_is_printed_reads_back(name):
    book = shipped_books()[name].book
    assert [read_primitive(str(each)) for each in book.primitives] == list(book.primitives)
    assert [read_recipe(str(each)) for each in book.recipes] == list(book.recipes)


@pytest.mark.parametrize(
    ("text", "column"),
    [
        ("", 1),
        ("(x)", 1),
        ("Sequence(x)", 1),
        ("root(x)", 1),
        ("go to(x)", 4),
        ("go(x", 5),
        ("go(x y)", 6),
        ("go(x, x)", 7),
        ("go(way-to, way_to)", 12),  # one port of a behaviour tree
        ("go(x?, y)", 8),
        ("go(x): flies to x", 8),
        ('go(x) "go|": moves to x', 7),
        ('go(x) "": moves to x', 7),
        ("go(x): moves to y", 17),
        ("go(x): moves x", 14),
        ("go(x): moves to x, moves to x", 20),
        ("go(x) “go”: moves to x", 7),
        ('go(x) "go {y}"', 7),
        ('go(x) "go', 7),
        ('go(x) "go {x"', 7),
        ('go(x) "go {x:many}"', 7),
        ("go(x): moves to x then", 19),
    ],
)
def test_an_error_in_a_primitive_says_where(text, column):
    position = error_of(read_primitive, text).position
    assert (position.source, position.line, position.column) == ("rows", 7, 2 + column)


@pytest.mark.parametrize(
    ("text", "column"),
    [
        ("go(x)", 6),
        ("go(x) ->", 9),
        ("go(x) -> move(y)", 15),
        ("go(x) -> move(colour of x)", 15),
        ("go(x) -> move(place of y)", 24),
        ("go(x) -> x = move(x)", 10),
        ("go(x, x) -> move(x)", 7),
        ("go(operator) -> move(operator)", 4),
        ("go(x: a(x), y: b(x)) -> move(x)", 1),
        ("go(x) -> say(answer) answer = ask(x)", 14),
        ("go(x:) -> move(x)", 6),
        (f"go(x) -> {'move(x) ' * 31}", 250),
    ],
)
def test_an_error_in_a_recipe_says_where(text, column):
    position = error_of(read_recipe, text).position
    assert (position.line, position.column) == (7, 2 + column)


def test_a_row_has_a_length_and_no_control_characters():
    assert "limit" in error_of(read_recipe, "go(x) -> move(x)" + " " * MAX_ROW).hint
    assert error_of(read_primitive, "go(x\x00)").position.column == 7


@given(st.text(max_size=60))
def test_any_text_is_read_or_refused(text):
    for read in (read_primitive, read_recipe):
        try:
            row = read(text)
        except LanguageError:
            continue
        assert read(str(row)) == row


@given(NAMES, st.lists(NAMES, min_size=1, max_size=4, unique=True), st.text('ab "\\|{', max_size=9))
def test_texts_in_quotation_marks_are_kept(name, parameters, text):
    quoted = text.replace("\\", "\\\\").replace('"', '\\"')
    recipe = read_recipe(f'{name}({", ".join(parameters)}) -> say("{quoted}")')
    assert recipe.calls[0].arguments[0].text == text
    assert read_recipe(str(recipe)) == recipe


def test_a_book_is_checked_as_a_whole():
    book, problems = read_book(
        "# what it can do\ngo_to(place): moves to place\ngo_to(place)\nsing()\nsay(text): speaks\nsay(",
        "go(x) -> go_to(x)\ngo(y: person) -> go_to(y)\n  go(x) -> go_to(x, x)\nfly(x) -> fly_to(x)\n"
        "ask(x) -> a = say(x)",
    )
    assert [str(each.position) for each in problems if each.is_error] == [
        "primitives:6:5",
        "primitives:3:1",
        "recipes:3:3",
        "recipes:3:12",
        "recipes:4:11",
        "recipes:5:11",
    ]
    warned = [str(each.position) for each in problems if not each.is_error]
    # Nothing uses sing; no plan calls an argument x or y.
    assert warned == [
        "primitives:4:1",
        *(f"recipes:{line}:{1 + 2 * (line == 3)}" for line in range(1, 6)),
    ]
    assert len(book.primitives) == 4 and len(book.recipes) == 5


def test_two_primitives_are_never_one_node_of_a_behaviour_tree():
    recipe = "find(thing) -> pick-up(thing) pick_up(thing)"
    _, problems = read_book("pick-up(x)\npick_up(x)\nput-down(x)", recipe)
    errors = [(each.position.line, each.message) for each in problems if each.is_error]
    assert errors == [
        (1, "“pick-up” is the node pick_up of a behaviour tree, and so is pick_up"),
        (2, "“pick_up” is the node pick_up of a behaviour tree, and so is pick-up"),
    ]


@pytest.mark.parametrize(
    ("recipe", "count"),
    [
        ("go(destination) -> move(destination)", 0),
        ("go(place) -> move(place)", 1),
        ("take(thing, thing_2) -> move(thing)", 0),
        ("dance(style) -> move(style)", 1),
        ("dance(argument_1) -> move(argument_1)", 0),
        ("say(text: answer(what), who) -> move(what)", 2),
        ("ask_operator(question, expects) -> move(question)", 0),
    ],
)
def test_an_argument_that_no_plan_has_is_a_warning(recipe, count):
    book, _ = read_book("move(place): moves to place", recipe)
    warnings = book.problems()
    assert len(warnings) == count and not any(each.is_error for each in warnings)


@pytest.mark.parametrize("name", shipped_books())
def test_a_book_that_ships_has_no_problem(name):
    assert shipped_books()[name].book.problems() == ()


def test_a_recipe_of_an_action_or_a_kind_that_a_world_lacks_is_a_warning():
    book, problems = read_book(
        "go_to(place)",
        "go(destination: persn) -> go_to(destination)\nfly(argument_1: room) -> go_to(argument_1)",
    )
    assert not problems
    warnings = book.problems(actions={"go"}, classes={"room"})
    assert [each.position.line for each in warnings] == [1, 2]
    assert not any(each.is_error for each in warnings)
