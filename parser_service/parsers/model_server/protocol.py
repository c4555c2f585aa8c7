"""How OpenAI's chat protocol is written and read, and where servers of it differ.

Sources: the API references of OpenAI, of llama.cpp's server, of Ollama and of vLLM (docs/guides/llm.md says what
each of them does with a JSON schema, a seed and the limit of tokens).
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from parser_service.parsers.model_server.exchange import NoAnswer, NoReply, Reply

Message = dict[str, str]

CHAT, MODELS = "/chat/completions", "/models"
SCHEMA_FIELD = "response_format"
MOST_DETAIL = 200  # characters of a server's own words
MOST_NAME = 200
THOUGHTS = re.compile(r"\A\s*<think>.*?</think>", re.DOTALL)
SURROGATES = re.compile("[\ud800-\udfff]")


@dataclass(frozen=True, slots=True)
class Question:
    """What a model is asked. ``schema`` is the JSON schema of its answer, None for a free text."""

    model: str
    messages: tuple[Message, ...]
    schema: Mapping[str, Any] | None
    seed: int
    max_tokens: int
    temperature: float = 0.0


@dataclass(frozen=True, slots=True)
class ModelAnswer:
    """What a model wrote, and its name as the server reports it."""

    text: str
    model: str


@dataclass(slots=True)
class Dialect:
    """What a server turned out not to understand; shared by all questions to it."""

    takes_schema: bool = True
    takes_system: bool = True
    limit: str = "max_tokens"
    learned: list[str] = field(default_factory=list)  # sentences about it, for the log

    def write(self, question: Question) -> bytes:
        """Return the body of the request."""
        messages = list(question.messages)
        if not self.takes_system and messages[0]["role"] == "system":
            # The person says first what a system message would say.
            first, second, *others = messages
            messages = [
                {**second, "content": f"{first['content']}\n\n{second['content']}"},
                *others,
            ]
        body: dict[str, Any] = {
            "model": question.model,
            "messages": messages,
            "temperature": question.temperature,
            "seed": question.seed,
            self.limit: question.max_tokens,
            "stream": False,
        }
        if question.schema is not None and self.takes_schema:
            body[SCHEMA_FIELD] = {
                "type": "json_schema",
                "json_schema": {"name": "answer", "strict": True, "schema": question.schema},
            }
        return json.dumps(body).encode()

    def learn(self, detail: str) -> None:
        """Follow what the server says about a refusal: that it calls the limit of tokens otherwise, or that
        the template of its model has no system messages (Gemma's and Mistral's first ones)."""
        if "max_completion_tokens" in detail:
            self.limit = "max_completion_tokens"
        if "system role" in detail.lower():
            self.takes_system = False

    def forget_schema(self, detail: str) -> None:
        """Send no schema any more: the server answers without one only."""
        if self.takes_schema:
            self.takes_schema = False
            self.learned.append(
                "The server does not take the JSON schema of the listed forms"
                f"{f' ({detail})' if detail else ''}. It is asked without; each answer is still checked "
                "against the list."
            )


def read_answer(reply: Reply, key: str) -> ModelAnswer:
    """Return the answer in a reply with status 200.

    Raises NoReply where it is none, and NoAnswer where the model ran out of tokens before it answered.
    """
    content = _json_of(reply)
    try:
        choice = content["choices"][0]
        message = choice["message"]
        text = _text_of(message)
    except (KeyError, IndexError, TypeError, AttributeError):
        detail = detail_of(reply, key)
        raise NoReply(f"its answer is none of the protocol{detail and f' ({detail})'}") from None
    text = THOUGHTS.sub("", text).strip()
    if not text and choice.get("finish_reason") == "length":
        raise NoAnswer(
            "The model had used all its tokens before it answered. Raise max_tokens, switch its thinking "
            "off, or give the server a longer context (docs/guides/llm.md)."
        )
    name = content.get("model")
    model = name if isinstance(name, str) else ""
    return ModelAnswer(cleaned(text, key), cleaned(model, key)[:MOST_NAME])


def read_models(reply: Reply, key: str) -> list[str] | None:
    """Return the names of the models that a server lists; None where it keeps no list."""
    if reply.status != 200:
        return None
    try:
        names = [each["id"] for each in _json_of(reply)["data"]]
    except (NoReply, KeyError, TypeError):
        return None
    return [cleaned(name, key)[:MOST_NAME] for name in names if isinstance(name, str)]


def is_model_of(name: str, listed: Sequence[str]) -> bool:
    """Return whether ``name`` is one of the ``listed``; Ollama also takes it without its tag."""
    return name in listed or f"{name}:latest" in listed


def detail_of(reply: Reply, key: str) -> str:
    """Return the server's own words about an error, cut and without the key; empty where it has none."""
    try:
        content = _json_of(reply)
        error = content.get("error", content) if isinstance(content, dict) else ""
        for name in ("message", "detail", "error"):
            error = error.get(name, error) if isinstance(error, dict) else error
    except NoReply:
        return ""
    return " ".join(cleaned(error, key).split())[:MOST_DETAIL] if isinstance(error, str) else ""


def cleaned(text: str, key: str) -> str:
    """Return a text of a server as rows and logs can hold it, without the ``key``."""
    hidden = text.replace(key, "…") if key else text
    return SURROGATES.sub("\ufffd", hidden).replace("\0", "")


def _json_of(reply: Reply) -> Any:
    try:
        return json.loads(reply.body)
    except (ValueError, RecursionError):
        raise NoReply("its answer is not JSON") from None


def _text_of(message: Mapping[str, Any]) -> str:
    """Return what the model wrote; nothing where it declined. Raises KeyError and TypeError."""
    content = message["content"]
    if content is None:
        if message.get("refusal") or message.get("reasoning_content") or message.get("reasoning"):
            return ""
        raise TypeError
    if isinstance(content, list):  # in parts
        return "".join(part["text"] for part in content if part.get("type") == "text")
    if not isinstance(content, str):
        raise TypeError
    return content
