"""The classes of entities that an ontology has, and those of GPSRCmdGen.

The classes are data of a world. ``entity_classes.toml`` beside this module says what GPSRCmdGen's files are made of:
a household. Imports bring these classes, a world by hand has only its own; nothing else lists them.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from annotations.language.forms.symbols import ALIASES, NO_ENTITY
from annotations.language.texts import LanguageError

# Letters and _ only: a number behind the token tells two tokens of one class apart, as in <object0>.
TOKEN = re.compile(r"[a-z](?:_?[a-z])*")
MAX_TOKEN = 20  # characters
MAX_CLASS_WORDS = 60  # characters of the words for a class
MOST_CLASSES = 100
HUES = 360  # degrees of a colour wheel (OKLCH)
FIRST_HUE = 145

# Words that mean something else where the token of a class can stand: in wildcards, as kinds of arguments, in glosses.
RESERVED = frozenset(
    (
        *(*ALIASES, *NO_ENTITY, "where", "meta", "plural"),
        *("variable", "lambda", "form", "number", "text", "unknown", "any"),
        *("it", "them", "sequence", "and", "or", "xor", "not", "null", "true", "false"),
    )
)


@dataclass(frozen=True, slots=True)
class EntityClass:
    """A class of entities.

    ``token`` is the word of its wildcard and its class token: ``{pose}``, ``<pose>``. ``hue`` is the angle
    of its colour in degrees. ``said`` is the noun for a slot that is left open: "find the object".

    The members of a closed class are all listed, and are descriptions or sentences (gestures, poses): one
    of their words is enough to recognise them in a paraphrase. Those of an open class are nouns or names,
    which come in the plural, too, and new ones may turn up.
    """

    token: str
    singular: str
    plural: str
    hue: int
    said: str
    is_closed: bool = False

    @property
    def has_plurals(self) -> bool:
        """Whether the members are said in the plural, too. People are not: "Grace" is nobody's plural."""
        return not self.is_closed and self.token != "name"


@dataclass(frozen=True)
class EntityClasses:
    """The classes of an ontology in order. Where words fit two classes equally well, the first is meant."""

    rows: tuple[EntityClass, ...]

    def __iter__(self) -> Iterator[EntityClass]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __contains__(self, token: object) -> bool:
        return token in self._by_token

    @cached_property
    def tokens(self) -> tuple[str, ...]:
        return tuple(self._by_token)

    def get(self, token: str) -> EntityClass | None:
        """Return the class of a token; None where there is none."""
        return self._by_token.get(token)

    def with_rows(self, rows: Iterable[EntityClass]) -> EntityClasses:
        """Return the classes with ``rows`` in the places of those of their tokens, and the others behind."""
        return EntityClasses(
            tuple({**self._by_token, **{each.token: each for each in rows}}.values())
        )

    def place(self, token: str) -> int:
        """Return the place of a class, from 0; the place behind the last for a token of no class."""
        return self._places.get(token, len(self.rows))

    def noun(self, token: str) -> str:
        """Return how an open slot of a class is said, without an article; the token's words by default."""
        known = self._by_token.get(token)
        return known.said if known else token.replace("_", " ")

    def singular(self, token: str) -> str:
        """Return the word for a member of a class; the token's words by default."""
        known = self._by_token.get(token)
        return known.singular if known else token.replace("_", " ")

    def plural(self, token: str) -> str:
        """Return the word for the members of a class; the token's words by default."""
        known = self._by_token.get(token)
        return known.plural if known else token.replace("_", " ")

    def has_plurals(self, token: str) -> bool:
        known = self._by_token.get(token)
        return known is not None and known.has_plurals

    def is_closed(self, token: str) -> bool:
        known = self._by_token.get(token)
        return known is not None and known.is_closed

    @cached_property
    def _by_token(self) -> dict[str, EntityClass]:
        return {each.token: each for each in self.rows}

    @cached_property
    def _places(self) -> dict[str, int]:
        return {token: place for place, token in enumerate(self._by_token)}


def is_token(text: str) -> bool:
    """Return whether a text is written like the token of a class."""
    return TOKEN.fullmatch(text) is not None


def wildcard_names(classes: EntityClasses) -> tuple[str, ...]:
    """Return the words with which a wildcard can begin: the classes, and what the generator has beside them.

    Its aliases, such as ``kobject``, are of some of its classes: a world without these has not got them.
    """
    aliases = (name for name, (kind, _) in ALIASES.items() if kind in classes)
    return tuple(dict.fromkeys((*classes.tokens, *NO_ENTITY, *aliases)))


def new_hue(classes: EntityClasses) -> int:
    """Return the hue that is the farthest from those of ``classes``."""
    taken = [each.hue for each in classes]

    def distance(hue: int) -> int:
        return min((min((hue - each) % HUES, (each - hue) % HUES) for each in taken), default=0)

    return max(range(0, HUES, 5), key=distance) if taken else FIRST_HUE


def require_token(token: str) -> None:
    """Raise LanguageError unless a class can have this token."""
    if not TOKEN.fullmatch(token):
        raise LanguageError(
            f"{token[:MAX_TOKEN] or 'an empty text'} is not the token of a class",
            hint="use small letters, and _ between words",
        )
    if len(token) > MAX_TOKEN:
        raise LanguageError(
            f"the token {token[:MAX_TOKEN]}… has {len(token):,} characters",
            hint=f"{MAX_TOKEN} is the limit",
        )
    if token in RESERVED and token not in DEFAULT_CLASSES:
        raise LanguageError(
            f"{token} means something else in wildcards, signatures or glosses",
            hint="choose another token",
        )


def read_default_classes(path: Path) -> EntityClasses:
    """Read the classes of GPSRCmdGen."""
    rows = tomllib.loads(path.read_text(encoding="utf-8"))["classes"]
    return EntityClasses(tuple(EntityClass(**row) for row in rows))


DEFAULT_CLASSES = read_default_classes(Path(__file__).with_suffix(".toml"))
