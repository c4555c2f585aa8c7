"""A question, and asking it."""

from __future__ import annotations

from parser_service.parsers.model_server.asker import Asker
from parser_service.parsers.model_server.protocol import Question
from parser_service.parsers.server_address import ModelServer
from tests.parser_service.llm_server import MODEL

SCHEMA = {"type": "object", "properties": {"form": {"enum": ["a", "UNKNOWN"]}}}


def question(text: str = "hello", schema=SCHEMA) -> Question:
    example = [{"role": "user", "content": "x"}, {"role": "assistant", "content": "a"}]
    messages = (*example, {"role": "user", "content": text})
    return Question(MODEL, messages, schema, 0, 100)


def ask(place: ModelServer, *questions: Question, check=lambda: None, at_once: int = 4):
    return [each.text for each in Asker(place, at_once).ask(questions, check)]
