"""Problems of one kind stand together, under what they have in common."""

from __future__ import annotations

from annotations.web.worlds.problem_groups import group_problems, in_common


def problem(message, hint="", severity="warning"):
    return {"severity": severity, "message": message, "hint": hint, "file": "a.txt", "line": 1}


def kinds(*problems):
    return [(each.count, each.title, each.hint) for each in group_problems(problems)]


def test_what_is_to_be_done_makes_the_kind():
    first = problem("$Main never reaches $a", "use it or remove it")
    second = problem("nothing defines $b", "define it or remove it")
    third = problem("$Main never reaches $c", "use it or remove it")
    assert kinds(first, second, third) == [
        (2, "$Main never reaches …", "use it or remove it"),
        (1, "nothing defines $b", "define it or remove it"),
    ]


def test_names_and_numbers_in_a_hint_do_not_part_a_kind():
    first = problem("ambiguous: 8 of 8 repeat", "remove it from one of the two lines of $a")
    second = problem("ambiguous: 2 of 3 repeat", "remove it from one of the two lines of $b")
    (group,) = group_problems([first, second])
    assert group.title == "ambiguous: … of … repeat"
    assert group.hint.endswith("lines of …") and not group.has_one_hint


def test_without_a_hint_the_message_makes_the_kind():
    assert kinds(problem('line 3 of "a b"'), problem('line 4 of "c"'), problem("it is empty")) == [
        (2, "line … of …", ""),
        (1, "it is empty", ""),
    ]


def test_errors_and_warnings_are_told_apart():
    assert [each.count for each in group_problems([problem("x"), problem("x", "", "error")])] == [
        1,
        1,
    ]


def test_messages_without_a_common_word_are_called_by_their_hint():
    assert kinds(problem("one", "remove it"), problem("two three", "remove it")) == [
        (2, "… remove it", "")
    ]


def test_texts_of_other_lengths_share_their_ends():
    assert in_common(["a b c z", "a x z", "a z"]) == "a … z"
    assert in_common(["a a", "a"]) == "a …"
    assert in_common(["same", "same"]) == "same"
