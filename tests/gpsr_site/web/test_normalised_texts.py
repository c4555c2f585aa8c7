"""What people and programs write is normalised on its way in, and they are told."""

from __future__ import annotations

import json

import pytest

from annotations.language.texts.errors import Refusal
from annotations.models import Entity, User, Utterance
from annotations.web.sent_texts import LONGEST_FIELD, SentTexts
from parser_service.serving.preparing import require_utterance
from tests.conftest import client_of
from tests.notices import levels
from tests.timing import least_seconds

ZERO_WIDTH, OVERRIDE, SOFT_HYPHEN = "\u200b", "\u202e", "\xad"
PAGE, ROUTE = "/w/home/utterances/new/", "/api/v1/worlds/home/utterances/"


def send(client, path: str, **sent: object):
    return client.post(path, json.dumps(sent), "application/json")


def test_the_page_after_a_form_says_what_was_changed(sample, anna):
    answer = anna.post(
        "/w/home/ontology/new/",
        {
            "entity_class": "object",
            "text": f"pl{ZERO_WIDTH}um{SOFT_HYPHEN}",
            "source": "objects.xml",
        },
        follow=True,
    )
    assert Entity.objects.filter(text="plum").exists()
    assert levels(answer)[-1] == "info" and " 2 " in str(list(answer.context["messages"])[-1])


def test_programs_are_told_in_a_header(sample, anna):
    answer = send(anna, ROUTE, texts=["find the plum", f"bring the{ZERO_WIDTH} plum{ZERO_WIDTH}"])
    assert answer.status_code == 201
    assert answer["Text-Changes"].startswith("texts.1: 2 ")
    assert "Text-Changes" not in send(anna, ROUTE, texts=["find the pear"])


@pytest.mark.parametrize("name", ["li\nne", "caf\u00e9\r\n", "n" * 50_000])
def test_the_header_holds_the_name_of_any_field(sample, anna, name):
    told = send(anna, ROUTE, **{name: ZERO_WIDTH, "texts": ["find the plum"]})["Text-Changes"]
    assert told.isascii() and told.isprintable() and len(told) <= 4_000
    answer = anna.get(ROUTE, {name[:5_000]: ZERO_WIDTH})
    assert answer.status_code < 500 and "invisible" in answer["Text-Changes"]


def test_names_of_fields_are_short_however_long_those_around_them_are():
    sent = SentTexts()
    sent.read_json({"n" * 10_000: [ZERO_WIDTH, {"m" * 10_000: ZERO_WIDTH}]})
    assert sent.changes and all(len(field) <= LONGEST_FIELD for field in sent.changes)


def test_equal_looking_utterances_are_one(sample, anna):
    looks_alike = [
        "go to the caf\u00e9",
        "go to the cafe\u0301",
        f"go{ZERO_WIDTH} to the caf\u00e9",
    ]
    answer = send(anna, ROUTE, texts=looks_alike).json()
    assert answer["added"] == 1 and len(answer["duplicates"]) == 2


@pytest.mark.parametrize("text", [ZERO_WIDTH, f" {OVERRIDE}\u2066 ", "\u3164\u2800", "\ufeff"])
def test_what_shows_nothing_is_no_utterance(text, sample, anna):
    before = Utterance.objects.count()
    assert anna.post(PAGE, {"text": text}).status_code == 422 or Utterance.objects.count() == before
    send(anna, ROUTE, texts=[text])
    assert Utterance.objects.count() == before
    with pytest.raises(Refusal) as refused:
        require_utterance(text)
    assert refused.value.code == "no_utterance"


def test_an_utterance_is_as_long_as_its_composed_letters():
    letter = "\ufb2c"  # one character that composing makes three of
    assert len(require_utterance(letter * 100)) == 300
    with pytest.raises(Refusal) as refused:
        require_utterance(letter * 300)
    assert refused.value.code == "utterance_too_long"
    assert refused.value.code == "utterance_too_long"


def test_lines_of_a_comment_stay(sample, anna):
    path = f"/api/v1/worlds/home/comments/template/{sample.template.pk}/"
    answer = send(anna, path, text=f"First.\n\n- o{ZERO_WIDTH}ne\n- two\u2028three")
    assert answer.json()["text"] == "First.\n\n- one\n- two\nthree"


def test_a_password_is_kept_as_it_was_typed(db):
    typed = f"corre{ZERO_WIDTH}ct horse cafe\u0301"
    user = User.objects.create_user("anna", password="correct horse")
    client = client_of(user)
    answer = client.post(
        "/password/",
        {"old_password": "correct horse", "new_password1": typed, "new_password2": typed},
    )
    assert answer.status_code == 302
    user.refresh_from_db()
    assert user.check_password(typed)


def test_who_searches_finds_it(sample, anna):
    send(anna, ROUTE, texts=["go to the café"])
    for asked in ("cafe\u0301", f"ca{ZERO_WIDTH}fé"):
        answer = anna.get(ROUTE, {"q": asked})
        assert [row["text"] for row in answer.json()["results"]] == ["go to the café"]


@pytest.mark.parametrize(
    ("sent", "field"),
    [
        ({"texts": ["\ud83d"]}, "texts.0"),
        ({"texts": ["a\0b"]}, "texts.0"),
        ({"origin": "\ud83d"}, "origin"),
        ({"\ud83d": 1}, "?"),
    ],
)
def test_what_is_no_text_is_refused_with_its_place(sent, field, sample, anna):
    answer = send(anna, ROUTE, **{"texts": ["find it"], **sent})
    assert answer.status_code == 400
    assert [each["field"] for each in answer.json()["problems"]] == [field]


def test_json_may_nest_as_deep_as_forms(sample, anna):
    deep = "[" * 100_000 + "]" * 100_000
    for body in (deep, '{"texts": ' + "[" * 70 + "]" * 70 + "}"):
        assert anna.post(ROUTE, body, "application/json").status_code == 400


def test_an_utterance_is_parsed_as_the_clean_one():
    assert require_utterance(f"bring me the{ZERO_WIDTH} plum") == "bring me the plum"
    assert require_utterance("go to the cafe\u0301\xa0now") == "go to the café now"


def test_a_long_name_costs_no_more_for_each_value_below_it():
    def seconds(length: int) -> float:
        return least_seconds(lambda: SentTexts().read_json({"n" * length: [""] * 20_000}))

    assert seconds(200_000) < 5 * seconds(200) + 0.1
