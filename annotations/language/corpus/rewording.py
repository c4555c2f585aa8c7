"""Rewordings of a form: its gloss with other gloss patterns, other joints and other small words.

People say a command in ways that no grammar lists. Where nobody has paraphrased a form, its rewordings stand in for
people: English that says the same, from the word lists in ``english/data/rewordings.toml``. The idea of training on
canonical sentences of forms and on paraphrases of them is that of Wang, Berant and Liang (2015), "Building a
semantic parser overnight"; here patterns, not people, paraphrase.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from random import Random

from annotations.language.forms import (
    CLASS_TOKEN,
    DEFAULT_CLASSES,
    Application,
    EntityClasses,
    Form,
    read_form,
    walk,
)
from annotations.language.texts import (
    REWORDED_JOINTS,
    REWORDED_PATTERNS,
    REWORDING_CLOSINGS,
    REWORDING_DETERMINERS,
    REWORDING_OPENINGS,
    REWORDING_PERSONS,
    REWORDING_THINGS,
)
from annotations.language.world import Predicate, PredicateKind, declared_or_inferred, gloss

# A class token as a text, which patterns for texts take too: "the person ‹pose›", not "in the pose".
_OPEN, _CLOSE = "‹", "›"
_SLOT = re.compile(
    rf"(\bthe )?{_OPEN}([^\W\d]+?\d*){_CLOSE}[^\W\d]*"
)  # with the ending of a plural
_SHARE_OF_DETERMINERS = 0.5  # of rewordings say "a" or nothing for "the"
_SHARE_OF_WHOEVER = 0.3
_THE = re.compile(r"\bthe (?=[^\W\d_]|<)")
_PRONOUN = re.compile(r"\b(?:it|them)\b")
_WHO_IS = re.compile(r"\bthe (?:person|one|individual) (?:who|that) is\b")
_BEFORE_SOMEONE = re.compile(r"\b(?:the|an?|some) (?=(?:someone|somebody|whoever)\b)")
_BEFORE_SIGN = re.compile(r" (?=[.,;])")


class Rewording:
    """Says forms in other words.

    Args:
        predicates: those of the world, with their gloss patterns.
        classes: the classes of its ontology.
    """

    def __init__(
        self, predicates: Mapping[str, Predicate], classes: EntityClasses = DEFAULT_CLASSES
    ) -> None:
        self._predicates = predicates
        self._classes = classes

    def say(self, form: str, random: Random) -> str:
        """Return a sentence for a form, with its class tokens.

        ``( go " <room> " )`` may be "please make your way to the <room>". Raises LanguageError where ``form``
        is no form.
        """
        read = read_form(CLASS_TOKEN.sub(rf"{_OPEN}\1{_CLOSE}", form))
        text = ""
        for part in self._parts(read):
            text += (random.choice(REWORDED_JOINTS) if text else "") + self._say_part(part, random)
        text = self._vary_words(text, random)
        words = (random.choice(REWORDING_OPENINGS), text, random.choice(REWORDING_CLOSINGS))
        return _BEFORE_SIGN.sub("", " ".join(" ".join(words).split()))

    def _parts(self, form: Form) -> tuple[Form, ...]:
        """Return the steps of a sequence; the form itself where it is none."""
        if not isinstance(form, Application):
            return (form,)
        declared = declared_or_inferred(self._predicates, form).get(str(form.predicate))
        is_sequence = declared is not None and declared.kind is PredicateKind.SEQUENCE
        return form.arguments if is_sequence else (form,)

    def _say_part(self, form: Form, random: Random) -> str:
        """Return the gloss of a form, with a pattern for each predicate that is drawn anew."""
        declared = declared_or_inferred(self._predicates, form)
        used = {str(each.predicate) for each in walk(form) if isinstance(each, Application)}
        drawn = {
            name: replace(declared[name], gloss=_draw(declared[name].gloss, random))
            for name in sorted(used)
        }
        return gloss(form, drawn, self._classes)

    def _vary_words(self, text: str, random: Random) -> str:
        """Return the text with class tokens, and with other small words."""
        text = _SLOT.sub(self._token, text)
        if random.random() < _SHARE_OF_WHOEVER:
            text = _WHO_IS.sub("whoever is", text)
        if random.random() < _SHARE_OF_DETERMINERS:
            text = _THE.sub(lambda _: f"{random.choice(REWORDING_DETERMINERS)} ".lstrip(), text)
        text = _BEFORE_SOMEONE.sub("", text)
        said = {"them": random.choice(REWORDING_PERSONS), "it": random.choice(REWORDING_THINGS)}
        return _PRONOUN.sub(lambda match: said[match[0]], text)

    def _token(self, match: re.Match[str]) -> str:
        """Return a class token; names and descriptions have no article."""
        article, token = match[1] or "", match[2]
        has_article = self._classes.has_plurals(token.rstrip("0123456789"))
        return f"{article if has_article else ''}<{token}>"


def _draw(pattern: str, random: Random) -> str:
    """Return a gloss pattern of which each alternative is drawn from those that say the same."""
    alternatives = map(str.strip, pattern.split("|"))
    return " | ".join(
        random.choice((each, *REWORDED_PATTERNS.get(each, ()))) for each in alternatives
    )
