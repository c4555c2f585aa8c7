"""Read the rows of a recipe book.

    go_to(place) "go to {place}": moves to place
    bring(thing, recipient) -> go_to(place of thing) find_object(thing) pick_up(thing) …

docs/reference/recipes.md says what a row can hold.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from annotations.language.plans.behavior_tree import TAKEN_NAMES, port_name
from annotations.language.plans.rows import (
    OPERATOR_WORD,
    PLACEHOLDER,
    ActionPattern,
    Argument,
    Call,
    Effect,
    EffectKind,
    Literal,
    Name,
    Parameter,
    Part,
    Primitive,
    PrimitiveParameter,
    Recipe,
    TheOperator,
)
from annotations.language.texts import (
    MAX_NESTING,
    MAX_PREDICATE,
    MAX_ROW,
    LanguageError,
    Position,
    require_length,
    require_name,
    require_writable,
)

MOST_CALLS = 30  # primitives of a recipe
MOST_PARAMETERS = 20
ARROW = "->"

_TOKEN = re.compile(
    r'\s*+(?:(?P<name>[^\W\d]\w*+(?:-\w++)*+)|(?P<text>"(?:[^"\\]|\\.)*+")|(?P<sign>->|[(),:=?|]))'
)
# Words between the verb of an effect and its parameter, and those before its target.
_BEFORE_SUBJECT = {EffectKind.MOVES: "to", EffectKind.SPEAKS: "to", EffectKind.ACTS: "on"}
_BEFORE_TARGET = {EffectKind.RELEASES: ("at", "to"), EffectKind.ACCOMPANIES: ("to",)}
_ABOUT_NOTHING = frozenset((EffectKind.SPEAKS, EffectKind.LEARNS))


def read_primitive(text: str, position: Position | None = None) -> Primitive:
    """Return the primitive of a row.

    Args:
        text: one row, such as ``pick_up(thing) "pick up {thing}": takes thing``.
        position: where the row starts in its source.

    Raises:
        LanguageError: the row cannot be read.
    """
    return _Row(text, position or Position(), "primitive").primitive()


def read_recipe(text: str, position: Position | None = None) -> Recipe:
    """Return the recipe of a row.

    Whether its primitives exist is for ``RecipeBook.problems`` to say.

    Args:
        text: one row, such as ``go(destination) -> go_to(destination)``.
        position: where the row starts in its source.

    Raises:
        LanguageError: the row cannot be read, or uses a name that its left side does not have.
    """
    return _Row(text, position or Position(), "recipe").recipe()


@dataclass(frozen=True, slots=True)
class _Token:
    kind: str  # name, text, sign, or end
    text: str
    position: Position


class _Row:
    """The tokens of a row, read from left to right."""

    def __init__(self, text: str, start: Position, what: str) -> None:
        require_length(text, what, MAX_ROW, start)
        require_writable(text, start)
        self._what = what
        self._start = start
        self._tokens: list[_Token] = []
        self._next = 0
        at = 0
        while text[at:].strip():
            match = _TOKEN.match(text, at)
            if match is None:
                rest = text[at:].lstrip()
                place = start.shifted(len(text) - len(rest))
                if rest.startswith('"'):
                    raise LanguageError("the text has no end", place, 'close it with "')
                raise LanguageError(
                    f"{rest[0]!r} is not expected here",
                    place,
                    f"a {what} has names, texts in quotation marks, and ( ) , : =",
                )
            kind = match.lastgroup or ""
            self._tokens.append(_Token(kind, match[kind], start.shifted(match.start(kind))))
            at = match.end()
        self._tokens.append(_Token("end", "the end", start.shifted(len(text))))

    def primitive(self) -> Primitive:
        name = self._name("the name of a primitive")
        if name in TAKEN_NAMES:
            message = f"BehaviorTree.CPP has a {name} of its own"
            raise LanguageError(message, self._start, "choose another name")
        parameters = self._parameters()
        said: tuple[str, ...] = ()
        if self._here.kind == "text":
            token = self._take()
            said = tuple(part.strip() for part in _unquoted(token.text).split("|"))
            for pattern in said:
                if not pattern:
                    hint = "write words between the signs |, or leave the text out"
                    raise LanguageError("a way of saying it is empty", token.position, hint)
                self._require_placeholders(pattern, parameters, token.position)
        effects: list[Effect] = []
        if self._skip(":"):
            effects.append(self._effect(parameters))
            while self._skip(","):
                place = self._here.position
                effects.append(self._effect(parameters))
                if effects[-1].kind in (each.kind for each in effects[:-1]):
                    raise LanguageError(
                        f"“{effects[-1].kind}” stands twice",
                        place,
                        "one effect of a kind is enough",
                    )
        self._end()
        return Primitive(name, parameters, said, tuple(effects), self._start)

    def recipe(self) -> Recipe:
        pattern = self._pattern()
        known = set()
        for name in pattern.names():
            if name in known:
                raise LanguageError(
                    f"two arguments are called {name}", self._start, "give each its own name"
                )
            known.add(name)
        self._expect(ARROW, "between the action and its primitives")
        calls: list[Call] = []
        while self._here.kind != "end":
            calls.append(self._call(known))
            self._skip(",")
        if not calls:
            hint = "write the primitives after ->, such as go_to(destination)"
            raise LanguageError("the recipe does nothing", self._here.position, hint)
        if len(calls) > MOST_CALLS:
            place = calls[MOST_CALLS].position
            raise LanguageError(
                f"the recipe has {len(calls)} primitives", place, f"{MOST_CALLS} is the limit"
            )
        return Recipe(pattern, tuple(calls), self._start)

    def _parameters(self) -> tuple[PrimitiveParameter, ...]:
        self._expect("(", "after the name")
        parameters: dict[str, PrimitiveParameter] = {}
        while not self._skip(")"):
            if parameters:
                self._expect(",", "between two parameters")
            place = self._here.position
            name = self._name("a parameter")
            is_optional = self._skip("?")
            if name in parameters:
                raise LanguageError(f"two parameters are called {name}", place, "rename one")
            twin = next((each for each in parameters if port_name(each) == port_name(name)), None)
            if twin is not None:
                port = port_name(name)
                message = f"“{name}” is the port {port} of a behaviour tree, and so is {twin}"
                raise LanguageError(message, place, "rename one")
            if not is_optional and any(each.is_optional for each in parameters.values()):
                raise LanguageError(
                    f"“{name}” comes after a parameter that can be left out",
                    place,
                    "put those with a question mark last",
                )
            self._require_few(len(parameters), place)
            parameters[name] = PrimitiveParameter(name, is_optional)
        return tuple(parameters.values())

    def _effect(self, parameters: tuple[PrimitiveParameter, ...]) -> Effect:
        token = self._here
        kinds = {str(kind): kind for kind in EffectKind}
        kind = kinds.get(self._name("an effect"))
        if kind is None:
            hint = f"write one of {', '.join(kinds)}"
            raise LanguageError(f"“{token.text}” is not an effect", token.position, hint)
        subject = target = preposition = noun = ""
        if kind is EffectKind.LEARNS:
            if self._here.kind == "text":
                text = self._take()
                noun = _unquoted(text.text)
                self._require_placeholders(noun, parameters, text.position)
            return Effect(kind, noun=noun)
        word = _BEFORE_SUBJECT.get(kind, "")
        if kind in _ABOUT_NOTHING and self._here.text != word:
            return Effect(kind)
        if word:
            self._expect(word, f"after “{kind}”")
        subject = self._parameter(parameters)
        if self._here.text in _BEFORE_TARGET.get(kind, ()):
            preposition = self._take().text
            target = self._parameter(parameters)
        return Effect(kind, subject, preposition, target)

    def _parameter(self, parameters: tuple[PrimitiveParameter, ...]) -> str:
        token = self._here
        name = self._name("a parameter")
        names = [each.name for each in parameters]
        if name not in names:
            hint = f"it has {', '.join(names)}" if names else "put it between the brackets"
            raise LanguageError(f"there is no parameter {name}", token.position, hint)
        return name

    def _require_placeholders(
        self, pattern: str, parameters: tuple[PrimitiveParameter, ...], position: Position
    ) -> None:
        names = [each.name for each in parameters]
        for match in PLACEHOLDER.finditer(pattern):
            if match[1] not in names:
                hint = f"it has {', '.join(names)}" if names else "write it without braces"
                raise LanguageError(f"there is no parameter {match[1]}", position, hint)
        if re.search(r"[{}]", PLACEHOLDER.sub("", pattern)):
            hint = "write a parameter as {thing}, or as {things:plural}"
            raise LanguageError("a brace has no partner", position, hint)

    def _pattern(self, depth: int = 0) -> ActionPattern:
        if depth > MAX_NESTING:
            raise LanguageError(
                "the actions are nested too deep",
                self._here.position,
                f"{MAX_NESTING} is the limit",
            )
        action = self._name("an action")
        self._expect("(", "after the action")
        parameters: list[Parameter] = []
        while not self._skip(")"):
            if parameters:
                self._expect(",", "between two arguments")
            place = self._here.position
            name = self._name("an argument")
            if name == OPERATOR_WORD:
                raise LanguageError(
                    f"no argument can be called {name}",
                    place,
                    "it is the person who gives commands",
                )
            if name in (each.name for each in parameters):
                raise LanguageError(f"two arguments are called {name}", place, "rename one")
            self._require_few(len(parameters), place)
            if not self._skip(":"):
                parameters.append(Parameter(name))
            elif self._tokens[self._next + 1].text == "(":
                parameters.append(Parameter(name, action=self._pattern(depth + 1)))
            else:
                parameters.append(Parameter(name, self._name("a kind, such as person or thing")))
        return ActionPattern(action, tuple(parameters))

    def _call(self, known: set[str]) -> Call:
        place = self._here.position
        name = self._name("a primitive")
        result = ""
        if self._skip("="):
            result = name
            if result in known or result == OPERATOR_WORD:
                raise LanguageError(
                    f"“{result}” is already a name", place, "give the result another one"
                )
            name = self._name("a primitive")
        self._expect("(", "after the primitive")
        arguments: list[Argument] = []
        while not self._skip(")"):
            if arguments:
                self._expect(",", "between two arguments")
            self._require_few(len(arguments), self._here.position)
            arguments.append(self._argument(known))
        if result:
            known.add(result)
        return Call(name, tuple(arguments), result, place)

    def _argument(self, known: set[str]) -> Argument:
        if self._here.kind == "text":
            return Literal(_unquoted(self._take().text))
        token = self._here
        name = self._name("an argument")
        part = None
        if self._skip("of"):
            parts = {str(each): each for each in Part}
            part = parts.get(name)
            if part is None:
                hint = f"write one of {', '.join(parts)}"
                raise LanguageError(f"nothing has a “{name}”", token.position, hint)
            token = self._here
            name = self._name("an argument")
        elif name == OPERATOR_WORD:
            return TheOperator()
        if name not in known:
            hint = (
                f"the left side has {', '.join(sorted(known))}" if known else "name it on the left"
            )
            raise LanguageError(f"there is no argument {name}", token.position, hint)
        return Name(name, part, token.position)

    @property
    def _here(self) -> _Token:
        return self._tokens[self._next]

    def _take(self) -> _Token:
        token = self._here
        self._next = min(self._next + 1, len(self._tokens) - 1)
        return token

    def _skip(self, text: str) -> bool:
        is_here = self._here.text == text and self._here.kind != "text"
        if is_here:
            self._take()
        return is_here

    def _expect(self, text: str, where: str) -> None:
        if not self._skip(text):
            token = self._here
            raise LanguageError(
                f"“{text}” is missing before {_shown(token)}", token.position, f"put it {where}"
            )

    def _name(self, what: str) -> str:
        token = self._here
        if token.kind != "name":
            raise LanguageError(
                f"{what} is missing before {_shown(token)}",
                token.position,
                "a name has letters, digits and _, with a letter first",
            )
        require_name(token.text, "name", MAX_PREDICATE, token.position)
        return self._take().text

    def _end(self) -> None:
        token = self._here
        if token.kind != "end":
            raise LanguageError(
                f"{_shown(token)} is not expected here",
                token.position,
                f"the {self._what} ends before it",
            )

    def _require_few(self, count: int, position: Position) -> None:
        if count >= MOST_PARAMETERS:
            raise LanguageError("there are too many", position, f"{MOST_PARAMETERS} is the limit")


def _shown(token: _Token) -> str:
    return token.text if token.kind == "end" else f"“{token.text}”"


def _unquoted(text: str) -> str:
    return re.sub(r"\\(.)", r"\1", text[1:-1])
