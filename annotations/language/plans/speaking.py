"""Say a task plan in English: each step, and all of it as one sentence that a robot can speak."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from annotations.language.forms import (
    NAMING,
    NOUN,
    PERSON,
    ROOM_CLASS,
    THING,
    THINGS,
    kind_of_class,
)
from annotations.language.grounding import QUESTION_WORD
from annotations.language.plans.plan import (
    Described,
    Named,
    Number,
    Operator,
    Referred,
    StepResult,
    TaskValue,
    Words,
)
from annotations.language.plans.rows import PLACEHOLDER, EffectKind, Primitive
from annotations.language.plans.task_plan import TaskPlan, TaskStep
from annotations.language.plans.values import PLACE, content, kinds_of
from annotations.language.texts import article, definite, looks_plural, plural

YOU = "you"
THE = "the "
ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth")
COME_BACK = "come back to you"
NOTHING = "I have nothing to do."
_PRONOUNS = {PERSON: "them", THING: "it"}
_ANSWER = "answer"  # what the operator has named
_OWNERS = {"them": "their", "it": "its"}
# Bounded, so that long texts take linear time.
_OF_PRONOUN = re.compile(
    r"\bthe (?P<what>\w+(?: (?!of\b)\w+){0,5}(?: “[^”]{0,200}”)?) of (?P<owner>them|it)\b"
)
_AT_HERE = re.compile(r" (?:on|to|at|in) here\b")
# What follows the noun of a description: "the person in a red coat who is waving".
_AFTER_NOUN = re.compile(r" (?=(?:who|that|in|at|on|with|wearing|near|from|named)\b)")
_IS = re.compile(r"\b(who|that|and) is\b")
_WITH_ONE = re.compile(
    r"\b(?P<how>in|with|wearing) an? (?P<what>[\w-]++(?: (?!(?:who|that|and|at|in)\b)[\w-]++){0,3})"
)
_CAPITAL = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
# What a person says about the robot, as the robot says it.
_TURNED = {
    "you are": "I am",
    "are you": "am I",
    "you can": "I can",
    "you do": "I do",
    "you have": "I have",
    "you like": "I like",
    "yourself": "myself",
    "yours": "mine",
    "your": "my",
    "you": "me",
}
_TO_TURN = re.compile(rf"\b({'|'.join(_TURNED)})\b", re.IGNORECASE)
_ON = re.compile(r"\bon (?=\{(\w+)\})")
_MOST_CLAUSES = 3  # after which "it" and "them" may stand for something else


def spoken(plan: TaskPlan) -> str:
    """Return one sentence for the robot to speak.

    >>> spoken(plan)
    'I will go to the kitchen, find a coke, take it, and bring it to you.'

    A plan that only asks is said as it asks.
    """
    questions = [_question_of(each) for each in plan.steps]
    if questions and all(questions):
        return " ".join(dict.fromkeys(questions))
    clauses = _Clauses(plan.steps).all()
    if not clauses:
        return NOTHING
    if len(clauses) > 2:
        clauses = [", ".join(clauses[:-1]) + ",", clauses[-1]]
    return f"I will {' and '.join(clauses)}."


def step_texts(steps: Sequence[TaskStep]) -> list[str]:
    """Return each step in English, to be read on its own."""
    clauses = _Clauses(steps)
    return [clauses.say(step, {}) for step in steps]


@dataclass
class _Clauses:
    """Says steps one after another; what was mentioned last is ``it`` or ``them``."""

    steps: Sequence[TaskStep]
    _last: dict[str, object] = field(default_factory=dict)  # person or thing → the last mentioned
    _since: dict[str, int] = field(default_factory=dict)  # person or thing → clauses since then
    _found: dict[str, object] = field(default_factory=dict)  # words → what has been found by them

    def all(self) -> list[str]:
        clauses = []
        at = 0
        while at < len(self.steps):
            step = self.steps[at]
            delivery = self._delivery(at)
            if delivery:  # the way there goes without saying
                clauses.append(self.say(step, self._last))
                self._remember(step)
                step = self.steps[at + delivery]
                effect = step.primitive.effect(EffectKind.RELEASES)
                assert effect is not None
                is_to_you = isinstance(_value(step, effect.target), Operator)
                pattern = f"bring {{{effect.subject}}} to {YOU}" if is_to_you else ""
                clauses.append(self.say(step, self._last, pattern))
            elif at and (asked := self._further_question(at)) and clauses[-1].endswith("”"):
                clauses[-1] += asked
            else:
                clauses.append(self.say(step, self._last))
            at += 1 + delivery
            self._remember(step)
        return clauses

    def _further_question(self, at: int) -> str:
        """Return what a step asks after another question, to be said with it: ``and “Where is it?”``."""
        before, asked = (_question_of(each) for each in self.steps[at - 1 : at + 1])
        is_last = at + 1 == len(self.steps) or not _question_of(self.steps[at + 1])
        return f"{' and' if is_last else ','} “{asked}”" if before and asked else ""

    def _delivery(self, at: int) -> int:
        """Return how many steps further on the thing that is taken now is left, if nothing but a move comes between.

        It is left at the place, or with the operator, where the robot is then; 0 if it is not.
        """
        take, *after = self.steps[at : at + 3]
        if not take.primitive.effect(EffectKind.TAKES):
            return 0
        place = take.place
        for distance, step in enumerate(after, start=1):
            released = step.primitive.effect(EffectKind.RELEASES)
            if released is None and not step.primitive.effect(EffectKind.MOVES):
                return 0
            if released is not None:
                target = _value(step, released.target)
                is_there = place and target and content(place) == content(target)
                return distance if is_there and step.releases == take.holds else 0
            place = step.place
        return 0

    def say(self, step: TaskStep, last: Mapping[str, object], pattern: str = "") -> str:
        """Return a step in English, with pronouns for what was mentioned last."""
        moves = step.primitive.effect(EffectKind.MOVES)
        if moves and isinstance(_value(step, moves.subject), Operator):
            return COME_BACK
        values = dict(step.arguments)
        found = step.primitive.effect(EffectKind.FINDS)
        new = found.subject if found else ""
        is_heard = any(PERSON in kinds_of(each) for each in values.values())

        def words(name: str, is_plural: bool) -> str:
            value = values.get(name)
            if isinstance(value, StepResult):
                if last.get(_ANSWER) == value.step:
                    is_person = PERSON in self._result(value.step, {})
                    return _PRONOUNS[PERSON if is_person else THING]
                return self._result(value.step, {} if is_heard else last)
            # "give them to them" says nothing of chips and of people.
            is_unclear = is_heard and looks_plural(_only(value, NOUN, THING))
            pronouns = {} if is_plural or is_unclear else last
            said = _say_value(value, pronouns, name == new, is_plural)
            return self._other(said, value) if name == new and value is not None else said

        text = _AT_HERE.sub(" here", _fill(pattern or _pattern(step.primitive, values), words))
        return _OF_PRONOUN.sub(lambda match: f"{_OWNERS[match['owner']]} {match['what']}", text)

    def _result(self, number: int, last: Mapping[str, object]) -> str:
        """Return what a step has learnt; with its place where another step learns what has the same words."""
        step = next((each for each in self.steps if each.number == number), None)
        if step is None or not _learnt(step, {}):
            return f"the result of step {number}"
        words = _learnt(step, {})
        alike = [each for each in self.steps if _learnt(each, {}) == words]
        if len(alike) > 1 and step.primitive.effect(EffectKind.SPEAKS) and words.startswith(THE):
            # Of answers that somebody gives in one place their order tells which is meant.
            ordinal = "".join(ORDINALS[alike.index(step) :][:1])
            return f"{THE}{ordinal} {words.removeprefix(THE)}" if ordinal else words
        is_one_of_many = len(alike) > 1
        is_one_of_many |= self._has_namesake(step)
        if is_one_of_many and step.place is not None:
            return f"{words} {_preposition(step.place)} {_noun_phrase(step.place, False, False)}"
        return _learnt(step, last)

    def _other(self, said: str, value: TaskValue) -> str:
        """Return ``another cup`` for ``a cup`` where the robot has found one before."""
        begin, _, noun = said.partition(" ")
        if begin not in ("a", "an"):
            return said
        is_other = self._found.setdefault(noun, _identity(value)) != _identity(value)
        return f"another {noun}" if is_other else said

    def _has_namesake(self, step: TaskStep) -> bool:
        """Return whether the plan is about somebody or something else that the same words describe."""
        owners = [each for _, each in step.arguments if isinstance(each, Described)]
        words = {_noun_phrase(each, False, False): _identity(each) for each in owners}
        others = (
            each
            for other in self.steps
            for _, each in other.arguments
            if isinstance(each, Described) and each.of is None
        )
        return any(
            words.get(_noun_phrase(each, False, False), _identity(each)) != _identity(each)
            for each in others
        )

    def _remember(self, step: TaskStep) -> None:
        """Remember whom and what a step has mentioned, and forget what was mentioned long before.

        What the robot has learnt can be called "it" too, so then nothing else is.
        """
        values = [value for _, value in step.arguments]
        for kind in list(self._last):
            self._since[kind] += 1
            if self._since[kind] > _MOST_CLAUSES:
                del self._last[kind]
        if any(isinstance(each, StepResult) for each in values):
            self._last.pop(THING, None)
        for value in values:
            for kind in kinds_of(value) & _PRONOUNS.keys():
                self._last[kind] = _identity(value)
                self._since[kind] = 0
            is_move = step.primitive.effect(EffectKind.MOVES) is not None
            if isinstance(value, StepResult) and not is_move and self._is_answer(value.step):
                self._last[_ANSWER] = value.step
                self._since[_ANSWER] = 0

    def _is_answer(self, number: int) -> bool:
        """Return whether a step asks the operator something."""
        asking = [each.primitive for each in self.steps if each.number == number]
        return any(each.effect(EffectKind.SPEAKS) and each.gives_result for each in asking)


def _question_of(step: TaskStep) -> str:
    """Return what a step asks the operator; empty where it does something else."""
    if not (step.gives_result and step.primitive.effect(EffectKind.SPEAKS)):
        return ""
    own = (each for _, each in step.arguments if isinstance(each, Words) and each.is_of_robot)
    return next((each.text for each in own), "")


def _learnt(step: TaskStep, last: Mapping[str, object]) -> str:
    """Return the result of a step in English; empty if it has no words for it."""
    effect = step.primitive.effect(EffectKind.LEARNS)
    values = dict(step.arguments)
    return _fill(
        effect.noun if effect else "",
        lambda name, is_plural: _say_value(
            values.get(name), {} if is_plural else last, False, is_plural
        ),
    )


def _preposition(place: TaskValue) -> str:
    """Return "in" for a room, "with" for the operator and "at" for any other place."""
    if isinstance(place, Operator):
        return "with"
    return "in" if _is_room(place) else "at"


def _is_room(value: TaskValue) -> bool:
    return isinstance(value, Named) and value.entity_class == ROOM_CLASS


def _pattern(primitive: Primitive, values: Mapping[str, TaskValue]) -> str:
    """Return the fullest pattern whose parameters all have a value; nothing is said to be on a room."""
    names = {
        each: {match["name"] for match in PLACEHOLDER.finditer(each)} for each in primitive.said
    }
    fitting = [each for each in primitive.said if names[each] <= values.keys()]
    if fitting:
        fullest = max(fitting, key=lambda each: len(names[each]))
        return _ON.sub(lambda match: "in " if _is_room(values[match[1]]) else match[0], fullest)
    name = _CAPITAL.sub(" ", primitive.name.replace("_", " ")).lower()
    return " ".join((name, *(f"{{{each}}}" for each in values)))


def _fill(pattern: str, words: Callable[[str, bool], str]) -> str:
    return PLACEHOLDER.sub(lambda match: words(match["name"], bool(match["is_plural"])), pattern)


def _say_value(
    value: TaskValue | None, last: Mapping[str, object], is_new: bool, is_plural: bool
) -> str:
    return _mention(value, last) or _noun_phrase(value, is_new, is_plural)


def _mention(value: TaskValue | None, last: Mapping[str, object]) -> str:
    """Return the pronoun for what was mentioned last; empty for anything else."""
    if value is None:
        return ""
    kinds = sorted(kinds_of(value) & _PRONOUNS.keys())
    pronoun = next((_PRONOUNS[each] for each in kinds if last.get(each) == _identity(value)), "")
    return "them" if pronoun and looks_plural(_only(value, NOUN, THING)) else pronoun


def _noun_phrase(value: TaskValue | None, is_new: bool, is_plural: bool) -> str:
    if isinstance(value, Referred):
        return _noun_phrase(value.value, is_new, is_plural)
    if isinstance(value, Operator):
        return YOU
    if isinstance(value, Number):
        return str(value.value)
    if isinstance(value, Words):
        if value.text == QUESTION_WORD:
            return f"the {value.text}"
        if value.said:
            return value.said
        return value.text if value.is_of_robot else _turned(value.text)
    if isinstance(value, Named):
        if kind_of_class(value.entity_class) not in ("", PERSON) or PLACE in kinds_of(value):
            return definite(value.text)
        if value.text.endswith("?"):
            return f"the question “{value.text}”"
        return _turned(value.text)
    if not isinstance(value, Described):
        return "something"
    if is_plural:
        return _plural_phrase(value.text)
    name = _only(value, NAMING, PERSON)
    if name:
        return name
    thing = _only(value, NOUN, THING, THINGS) if is_new else ""
    if thing and not looks_plural(thing):
        return f"{article(thing)} {thing}"
    return value.text or "it"


def _turned(text: str) -> str:
    """Return what a person says about the robot, as the robot says it."""
    return _TO_TURN.sub(lambda match: _TURNED[match[0].lower()], text)


def _plural_phrase(text: str) -> str:
    """Return ``the people in red coats who are waving`` for ``the person in a red coat who is waving``."""
    head, *rest = _AFTER_NOUN.split(text.removeprefix("the "), maxsplit=1)
    if not rest:
        return f"the {plural(head)}"
    clauses = _WITH_ONE.sub(lambda match: f"{match['how']} {plural(match['what'])}", rest[0])
    return f"the {plural(head)} {_IS.sub(lambda match: f'{match[1]} are', clauses)}"


def _only(value: TaskValue | None, predicate: str, *kinds: str) -> str:
    """Return the one entity that describes a value; empty where more is said of it."""
    if not isinstance(value, Described):
        return ""
    conditions = [each for each in value.conditions if each.values]
    others = [each for each in value.conditions if not each.values and each.predicate not in kinds]
    if others or len(conditions) != 1 or conditions[0].predicate != predicate:
        return ""
    (entity, *_) = conditions[0].values
    is_entity = isinstance(entity, Named) and kind_of_class(entity.entity_class) in kinds
    return entity.text if is_entity and isinstance(entity, Named) else ""


def _identity(value: TaskValue) -> object:
    return value.id if isinstance(value, Described) else content(value)


def _value(step: TaskStep, parameter: str) -> TaskValue | None:
    return dict(step.arguments).get(parameter)
