"""What a person did wrong: one kind of exception, with a code."""

from __future__ import annotations

import pytest

from annotations.language.texts.errors import LanguageError, Position, Refusal


class Taken(Refusal):
    code = "taken"
    status = 409


def test_a_refusal_has_a_sentence_a_code_and_a_status():
    refusal = Refusal("Write a name.", "no_name")
    assert (str(refusal), refusal.code, refusal.status) == ("Write a name.", "no_name", 400)
    assert (Taken("It is taken.").code, Taken("It is taken.").status) == ("taken", 409)
    assert Refusal("Too long.", "too_long", 413).status == 413


def test_a_text_that_cannot_be_read_is_one_with_a_place():
    with pytest.raises(Refusal) as caught:
        raise LanguageError("a bracket is missing", Position("a.txt", 2, 3), "add one")
    assert caught.value.code == "unreadable"
    assert (caught.value.position.line, caught.value.position.column) == (2, 3)
    assert caught.value.message == "a bracket is missing"
