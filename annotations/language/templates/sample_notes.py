"""What is asked for by somebody who wants a sample of a language, and what is said of the sample afterwards."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Self

from annotations.language.grammar import readable
from annotations.language.texts import Refusal

# Python refuses to print numbers that are longer. A language of more derivations is said to have so many.
MOST_COUNTED = 10**4_000
MOST_SAMPLED = 1_000_000
LARGEST_SEED = 2**63 - 1


class Balance(StrEnum):
    """What a sample has equally often: nothing but derivations, the lines of the templates, or the forms."""

    NONE = "none"
    LINES = "lines"
    FORMS = "forms"


@dataclass(frozen=True, slots=True)
class SampleRequest:
    """``size`` commands, drawn under a ``seed``; all commands where ``size`` is 0.

    The same world and request give the same sample.
    """

    size: int
    seed: int = 0
    balance: Balance = Balance.NONE


EVERYTHING = SampleRequest(0)


@dataclass(frozen=True, slots=True)
class SampleNote:
    """What is remembered of a sample: ``commands`` of them were drawn of a language with ``of`` derivations.

    ``is_all`` says that these are all commands of the language, which has no more than were asked for.
    """

    request: SampleRequest
    commands: int
    of: int
    is_all: bool = False

    def __str__(self) -> str:
        return f"a sample of {self.commands:,} of {readable(self.of)}"

    @property
    def details(self) -> str:
        """The seed, and what is balanced."""
        balanced = (
            "" if self.request.balance == Balance.NONE else f", balanced by {self.request.balance}"
        )
        return f"seed {self.request.seed}{balanced}"

    def as_json(self) -> dict[str, Any]:
        """Return the note as it is stored; ``of`` is text, since it may be longer than a JSON number."""
        return {
            "commands": self.commands,
            "of": str(min(self.of, MOST_COUNTED)),
            "is_all": self.is_all,
            "size": self.request.size,
            "seed": self.request.seed,
            "balanced": str(self.request.balance),
        }

    @classmethod
    def from_json(cls, stored: object) -> Self | None:
        """Return the note that ``as_json`` gave; None where nothing is stored.

        Raises:
            Refusal: this is no note.
        """
        if stored in (None, {}):
            return None
        if not isinstance(stored, dict) or set(stored) != _KEYS:
            raise Refusal("a note about a sample has other keys", NO_NOTE)
        numbers = [stored[name] for name in ("commands", "size", "seed")]
        if not all(type(each) is int and 0 <= each <= LARGEST_SEED for each in numbers):
            raise Refusal("a number in a note about a sample is not one", NO_NOTE)
        of = stored["of"]
        if not isinstance(of, str) or not of.isascii() or not of.isdigit() or len(of) > 4_001:
            raise Refusal("the size of the language of a sample is not one", NO_NOTE)
        if type(stored["is_all"]) is not bool:
            raise Refusal("is_all is neither true nor false", NO_NOTE)
        if stored["balanced"] not in list(Balance):
            raise Refusal("a sample is balanced in no such way", NO_NOTE)
        request = SampleRequest(stored["size"], stored["seed"], Balance(stored["balanced"]))
        return cls(request, stored["commands"], int(of), stored["is_all"])


NO_NOTE = "no_sample_note"
_KEYS = {"commands", "of", "is_all", "size", "seed", "balanced"}
