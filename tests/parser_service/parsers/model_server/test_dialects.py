"""What servers take and say differently: schemas, limits, roles and the parts of an answer."""

from __future__ import annotations

from dataclasses import replace

import pytest

from annotations.language.texts.errors import Refusal
from parser_service.parsers.model_server.asker import Asker
from tests.parser_service.llm_server import fails, says
from tests.parser_service.parsers.model_server.questions import ask, question


@pytest.mark.parametrize("status", [400, 500])  # llama-cpp-python answers with the latter
def test_a_server_that_knows_no_schema_is_asked_without_and_the_log_says_so(
    place, tiny, caplog, status
):
    def without_schema(handler):
        if "response_format" in handler.server.asked[-1]:
            return fails(status, "unknown field: response_format")(handler)
        return says("a")(handler)

    tiny.always = without_schema
    asker = Asker(place, 1)
    assert [each.text for each in asker.ask([question(), question("b")], lambda: None)] == [
        "a",
        "a",
    ]
    assert ["response_format" in each for each in tiny.asked] == [True, False, False]
    [sentence] = asker.dialect.learned
    assert "JSON" in sentence and "unknown field" in sentence
    assert [record.message for record in caplog.records] == [sentence]


def test_a_question_that_is_refused_with_and_without_its_schema_is_refused(place, tiny):
    tiny.always = fails(400, "the prompt is longer than the context")
    with pytest.raises(Refusal, match=r"\b400, the prompt is longer") as refused:
        ask(place, question())
    assert refused.value.code == "language_model_refused"
    assert len(tiny.asked) == 2


def test_a_server_that_calls_the_limit_otherwise_is_understood(place, tiny):
    def only_completion_tokens(handler):
        if "max_tokens" in handler.server.asked[-1]:
            words = "Unsupported parameter: 'max_tokens'. Use 'max_completion_tokens' instead."
            return fails(400, words)(handler)
        return says("a")(handler)

    tiny.always = only_completion_tokens
    assert ask(place, question(), question("b"), at_once=1) == ["a", "a"]
    assert [each.get("max_completion_tokens") for each in tiny.asked] == [None, 100, 100]
    assert all("response_format" in each for each in tiny.asked)


def test_a_model_without_system_messages_is_told_the_task_by_the_person(place, tiny):
    def only_people(handler):
        if handler.server.asked[-1]["messages"][0]["role"] == "system":
            return fails(400, "System role not supported")(handler)
        return says("a")(handler)

    tiny.always = only_people
    asked = question()
    asked = replace(asked, messages=({"role": "system", "content": "Translate."}, *asked.messages))
    assert ask(place, asked) == ["a"]
    assert [each["role"] for each in tiny.asked[-1]["messages"]] == ["user", "assistant", "user"]
    assert tiny.asked[-1]["messages"][0]["content"] == "Translate.\n\nx"
    assert len(tiny.asked) == 2 and "response_format" in tiny.asked[-1]


def test_a_model_that_thinks_until_its_tokens_are_used_is_told_from_a_silent_one(place, tiny):
    tiny.faults = [says("", finish_reason="length")]
    with pytest.raises(Refusal, match="max_tokens") as refused:
        ask(place, question())
    assert refused.value.code == "language_model_refused"
    tiny.faults = [says(None, finish_reason="length", message={"reasoning_content": "Hmm"})]
    with pytest.raises(Refusal, match="max_tokens") as refused:
        ask(place, question())
    assert refused.value.code == "language_model_refused"
    tiny.faults = [says(None, message={"refusal": "I cannot help with that."})]
    assert ask(place, question()) == [""]


def test_content_in_parts_is_put_together(place, tiny):
    tiny.faults = [says([{"type": "text", "text": "a"}, {"type": "text", "text": "b"}])]
    assert ask(place, question()) == ["ab"]
