from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import (
    INSTRUCTIONS,
    Named,
    check_instructions,
    instructions_version,
    rewrite_request,
    rewrites_in,
)
from annotations.language.corpus.model_replies import LONGEST_REPLY, LONGEST_REWRITE
from annotations.language.texts.errors import Refusal
from tests.timing import least_seconds

THREE = ("Fetch the tea, would you?", "I'd like the tea", "tea, now")


@pytest.mark.parametrize(
    "reply",
    [
        "1. Fetch the tea, would you?\n2. I'd like the tea\n3. tea, now",
        "1) Fetch the tea, would you?\n2) I'd like the tea\n3) tea, now\n",
        "(1) Fetch the tea, would you?\n(2) I'd like the tea\n(3) tea, now\n",
        "* Fetch the tea, would you?\n* I'd like the tea\n* tea, now",
        "- “Fetch the tea, would you?”\n- “I'd like the tea”\n- “tea, now”",
        "• **Fetch the tea, would you?**\n• *I'd like the tea*\n• _tea, now_",
        "Sure! Here are three:\n\n1. Fetch the tea, would you?\n\n2. I'd like the tea\n\n3. tea, now\n\nAnything else?",
        "Fetch the tea, would you?\nI'd like the tea\ntea, now",
        "Here you are:\nFetch the tea, would you?\nI'd like the tea\ntea, now",
        json.dumps(THREE),
        f"```json\n{json.dumps(THREE, indent=2)}\n```",
        f"The answer is {json.dumps({'paraphrases': THREE})} as you asked.",
        json.dumps([{"text": each, "style": "x"} for each in THREE]),
        json.dumps(dict(enumerate(THREE))),
        "<think>\n1. they want tea\n</think>\n1. Fetch the tea, would you?\n2. I'd like the tea\n3. tea, now",
        "they want tea\n</think>\n1. Fetch the tea, would you?\n2. I'd like the tea\n3. tea, now",
        "1. Fetch the tea, would you?\n2. I'd like the tea\n3. tea, now\n<think>1. was that good",
        "1. Complex: Fetch the tea, would you?\n2. **Medium:** I'd like the tea\n3. (simple) tea, now",
        "Version 1: Fetch the tea, would you?\nVersion 2: I'd like the tea\nVersion 3: tea, now",
        "1. Fetch the tea, would you?\r\n2. I'd like the tea\u200b\r\n3. tea,\u00a0now\r\n3. tea, now",
    ],
)
def test_rewrites_are_found_in_every_kind_of_reply(reply: str) -> None:
    assert rewrites_in(reply) == THREE


@pytest.mark.parametrize(
    "reply", ["", " \n", "<think>on and on", "[]", "{}", "Here are three:", f"1. {'x' * 501}"]
)
def test_a_reply_without_rewrites_gives_none(reply: str) -> None:
    assert rewrites_in(reply) == ()


def test_brackets_in_prose_are_no_json() -> None:
    assert rewrites_in("1. bring [the] tea {now}") == ("bring [the] tea {now}",)


def test_a_command_with_a_colon_stays_whole() -> None:
    assert rewrites_in("1. Robot: fetch the tea\n2. go: tea") == ("Robot: fetch the tea", "go: tea")


@given(st.text(max_size=300))
def test_any_reply_is_read(reply: str) -> None:
    rewrites = rewrites_in(reply)
    assert len(set(rewrites)) == len(rewrites)
    assert all(0 < len(each) <= LONGEST_REWRITE for each in rewrites)


@pytest.mark.parametrize(
    "part", ["[", "{", '["', "1. ", "<think>", "*", "(1", "“", "a) ", '"', "*_", '{"a":[']
)
def test_no_reply_takes_long(part: str) -> None:
    reply = part * (LONGEST_REPLY // len(part))
    assert least_seconds(lambda: rewrites_in(reply), times=2) < 2


def test_a_request_has_command_names_and_number() -> None:
    entities = [Named("tea"), Named("pointing left", is_described=True), Named("den")]
    request = rewrite_request("{count}: {names} | {command} {x}", "bring {names}", entities, 3)
    assert request == "3: “tea”, “den” | bring {names} {x}"


def test_own_instructions_need_a_place_for_the_command() -> None:
    check_instructions(INSTRUCTIONS)
    with pytest.raises(Refusal) as refused:
        check_instructions("say it again")
    assert refused.value.code == "no_command_place"
    with pytest.raises(Refusal) as refused:
        check_instructions("{command}" * 1000)
    assert refused.value.code == "too_long"


def test_instructions_are_told_apart() -> None:
    assert instructions_version("a {command}") != instructions_version("b {command}")
