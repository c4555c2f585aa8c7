"""Verb: export what people say for commands with the plan in the team's own primitives, to train and test models."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from http import HTTPStatus
from typing import Any

from django.db import models
from django.db.models import QuerySet

from annotations.exchange.tables import text_pieces
from annotations.language.corpus import Part
from annotations.language.forms import (
    NAMING,
    NOUN,
    PERSON,
    read_form,
)
from annotations.language.plans import (
    Described,
    Named,
    Number,
    Operator,
    RecipeBook,
    RecipeTrouble,
    Referred,
    StepResult,
    TaskPlan,
    Value,
    Words,
)
from annotations.language.texts import LanguageError, Refusal, folded_words
from annotations.models import Paraphrase, Split, World
from annotations.models.splits import Source
from annotations.rows.task_plans import TaskPlanner

CHUNK = 500  # rows fetched at once
UNDONE = frozenset(map(str, RecipeTrouble))
OPERATOR = "operator"
INSTRUCTIONS = (
    "You plan for a service robot. Turn the command into the primitives of the robot, in order. Answer with a JSON "
    'array of steps and nothing else. A step is an object with "primitive" and "arguments". "operator" is the person '
    'who gave the command. {{"result": 3}} is what step 3 has found out. The primitives are: {primitives}.'
)


class RephrasedFormat(models.TextChoices):
    """JSON Lines, each: ``chat`` has the messages of a conversation, as fine-tuning takes them, ``pairs`` an
    utterance and its plan in one line of text, ``tests`` an input and what is expected of it."""

    CHAT = "chat"
    PAIRS = "pairs"
    TESTS = "tests"


@dataclass
class RephrasedExport:
    """The accepted ones of the paraphrases ``rows`` of ``world``, in their order.

    ``as_`` is a ``RephrasedFormat``. With ``split`` those alone whose utterance is in its ``part``, by default the
    training part, where none of them is left that is in another part in other letters or punctuation. ``cases`` and
    ``left_out`` count, while ``pieces`` is read, what was written, and what was not: texts that are no form, and plans
    that recipes do not say all of. The latter are in ``tests`` all the same.

    Raises Refusal for a part without a split.
    """

    world: World
    rows: QuerySet[Paraphrase]
    as_: str
    split: Split | None = None
    part: str | None = None
    cases: int = field(default=0, init=False)
    left_out: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        if self.part and self.split is None:
            raise Refusal(
                "Paraphrases are in a part of a split: say which split.",
                "split_needed",
                HTTPStatus.BAD_REQUEST,
            )
        if self.split is not None:
            self.part = self.part or str(Part.TRAIN)

    @property
    def file_name(self) -> str:
        of_split = (self.split.name, self.part) if self.split else ()
        return f"{'-'.join(map(str, (self.world.name, self.as_, *of_split)))}.jsonl"

    def pieces(self) -> Iterator[bytes]:
        """Yield the file in pieces, none of them large."""
        return text_pieces(f"{json.dumps(case, ensure_ascii=False)}\n" for case in self._cases())

    def _cases(self) -> Iterator[dict[str, Any]]:
        planner = TaskPlanner.of(self.world)
        chosen = _UtterancesOfPart(self.split, self.part) if self.split and self.part else None
        system = instructions(planner.book)
        rows = self.rows.accepted().select_related("contributor").order_by("position")  # type: ignore[attr-defined]  # a query set of ours
        for row in rows.iterator(chunk_size=CHUNK):
            if chosen is not None and row.utterance not in chosen:
                continue
            plan = _plan(planner, row.grounded_form)
            if plan is None or (self.as_ != RephrasedFormat.TESTS and _is_undone(plan)):
                self.left_out += 1
                continue
            self.cases += 1
            yield self._case(row, plan, system)

    def _case(self, row: Paraphrase, plan: TaskPlan, system: str) -> dict[str, Any]:
        match RephrasedFormat(self.as_):
            case RephrasedFormat.CHAT:
                answer = json.dumps(list(steps_of(plan)), ensure_ascii=False)
                said = (("system", system), ("user", row.utterance), ("assistant", answer))
                return {"messages": [{"role": role, "content": text} for role, text in said]}
            case RephrasedFormat.PAIRS:
                return {"utterance": row.utterance, "target": plan_line(plan)}
        return {
            "id": row.pk,
            "command": row.prompt,
            "input": row.utterance,
            "source": str(Source.MODEL if row.is_by_model else Source.PARAPHRASED),
            "part": self.part or "",
            "form": row.grounded_form,
            "expected": plan.as_json(),
        }


def _plan(planner: TaskPlanner, text: str) -> TaskPlan | None:
    """Return the plan of a stored form; None for a text that is no form."""
    try:
        return planner.plan(read_form(text))
    except LanguageError:
        return None


def _is_undone(plan: TaskPlan) -> bool:
    """Return whether recipes do not say how to do all of it, so that it is no target."""
    return any(each.code in UNDONE for each in plan.problems)


class _UtterancesOfPart:
    """The utterances of a part of a split, but for commands."""

    def __init__(self, split: Split, part: str) -> None:
        said = split.examples.exclude(source=Source.GENERATED)
        self._mine = set(said.filter(part=part).values_list("utterance", flat=True))
        self._others: set[tuple[str, ...]] = set()
        if part == Part.TRAIN:
            held_out = said.exclude(part=part).values_list("utterance", flat=True)
            self._others = {tuple(folded_words(text)) for text in held_out.iterator(CHUNK)}

    def __contains__(self, utterance: str) -> bool:
        return utterance in self._mine and tuple(folded_words(utterance)) not in self._others


def instructions(book: RecipeBook) -> str:
    """Return what a model is told before it is given a command: what to answer, and the primitives of ``book``."""
    primitives = (
        f"{each.name}({', '.join(map(str, each.parameters))})" for each in book.primitives
    )
    return INSTRUCTIONS.format(primitives="; ".join(primitives))


def steps_of(plan: TaskPlan) -> Iterator[dict[str, Any]]:
    """Yield the steps as short plain data: a primitive and its arguments by name."""
    for step in plan.steps:
        arguments = {name: short_value(value) for name, value in step.arguments}
        yield {"primitive": step.action, "arguments": arguments}


def plan_line(plan: TaskPlan) -> str:
    """Return the steps as one line of text, arguments in the order of the primitive.

    >>> plan_line(plan)
    'go_to("kitchen") find_object("coke") pick_up("coke") go_to(operator) give("coke", operator)'
    """
    return " ".join(
        f"{step.action}({', '.join(_written(value) for _, value in step.arguments)})"
        for step in plan.steps
    )


def short_value(value: Value | Operator) -> Any:
    """Return an argument as a text, a number, or ``{"result": STEP}``.

    What is described by one entity alone is that entity; else it is its description in English.
    """
    if isinstance(value, Referred):
        return short_value(value.value)
    if isinstance(value, Operator):
        return OPERATOR
    if isinstance(value, StepResult):
        return {"result": value.step}
    if isinstance(value, Number):
        return value.value
    if isinstance(value, Named | Words):
        return value.text
    return _entity_of(value) or value.text if isinstance(value, Described) else ""


def _entity_of(value: Described) -> str:
    """Return the entity that is all that is said of something, but for what it is: a person."""
    entities = [each for condition in value.conditions for each in condition.values]
    others = [each for each in value.conditions if not each.values]
    first = entities[0] if len(entities) == 1 and len(others) < 2 else None
    is_only = all(each.predicate in (PERSON, NOUN, NAMING) for each in value.conditions)
    return first.text if isinstance(first, Named) and is_only else ""


def _written(value: Value | Operator) -> str:
    short = short_value(value)
    if isinstance(short, dict):
        return f"#{short['result']}"
    return OPERATOR if isinstance(value, Operator) else json.dumps(short, ensure_ascii=False)
