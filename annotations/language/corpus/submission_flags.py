"""What may be wrong with a submission: flags with evidence for the moderator. None rejects by itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache

from rapidfuzz.distance import Levenshtein

from annotations.language.corpus.distances import distance
from annotations.language.corpus.rewrite_checks import Named, lost_entities
from annotations.language.texts import COURTESY_WORDS, folded_words

ALIKE = 0.9  # normalised Levenshtein similarity at which two texts count as the same
LEAST_SECONDS = 2.0  # to read a prompt and to write anything
MOST_EDITS_A_SECOND = 12.0  # 144 words a minute: few type as fast
MOST_UNKNOWN = 0.4  # share of the letters that stand in words which nobody knows
LEAST_WORDS = 2  # of a command of one's own


class FlagCode(StrEnum):
    """What a flag says of a submission."""

    COPY = "copy"  # the words of the prompt, but for courtesy
    REPEAT = (
        "repeat"  # written before: by the contributor for another prompt, or by others for this one
    )
    TOO_FAST = "too_fast"
    LOST_ENTITY = "lost_entity"
    GIBBERISH = "gibberish"  # or another language
    CHECK_FAILED = "check_failed"  # the words that a planted check asks for are missing
    SPAM = "spam"  # a free command that is none
    PASTED = "pasted"
    LIKE_MODEL = "like_model"  # close to what a language model wrote for the same form
    OTHER_FORM = "other_form"  # a parser that has not seen it is sure of another form


@dataclass(frozen=True, slots=True)
class Flag:
    """``evidence`` is what the code was given for: the words, the other text, the figure."""

    code: FlagCode
    evidence: str = ""


@dataclass(frozen=True, slots=True)
class Rewrite:
    """A rewrite of a prompt, and the texts it is compared with.

    Attributes:
        seconds: between the prompt's appearance and the answer; None where nobody measured it.
        own: what the contributor wrote for other prompts.
        others: what others wrote for the same prompt.
        of_models: what language models wrote for the same form; empty for a model's own.
    """

    text: str
    prompt: str
    entities: Sequence[Named] = ()
    seconds: float | None = None
    was_pasted: bool = False
    own: Sequence[str] = ()
    others: Sequence[str] = ()
    of_models: Sequence[str] = ()


@dataclass(frozen=True, slots=True)
class FreeCommand:
    """A command of the contributor's own; ``prompts`` are those that they had seen, ``own`` what they wrote."""

    text: str
    prompts: Sequence[str] = ()
    own: Sequence[str] = ()
    was_pasted: bool = False


# Says whether a folded word is known: an English one, or one of the world.
Knows = Callable[[str], bool]


def rewrite_flags(rewrite: Rewrite, knows: Knows) -> tuple[Flag, ...]:
    """Return the flags of a rewrite, in the order of ``FlagCode``."""
    return tuple(_rewrite_flags(rewrite, knows))


def _rewrite_flags(rewrite: Rewrite, knows: Knows) -> Iterator[Flag]:
    is_reordered = sorted(bare_words(rewrite.text).split()) == sorted(
        bare_words(rewrite.prompt).split()
    )
    if is_reordered or _is_same(rewrite.text, rewrite.prompt):
        yield Flag(FlagCode.COPY, rewrite.prompt)
    said = bare_words(rewrite.text)
    # Equal and not alike: who says two prompts with other entities in one way repeats nothing.
    earlier = (*rewrite.own, *rewrite.others)
    repeated = next((each for each in earlier if bare_words(each) == said), None)
    if repeated is not None:
        yield Flag(FlagCode.REPEAT, repeated)
    if rewrite.seconds is not None and rewrite.seconds < _least_seconds(rewrite):
        yield Flag(FlagCode.TOO_FAST, f"{rewrite.seconds:.1f} s")
    if lost := lost_entities(rewrite.text, rewrite.entities):
        yield Flag(FlagCode.LOST_ENTITY, ", ".join(lost))
    if unknown := unknown_words(rewrite.text, knows):
        yield Flag(FlagCode.GIBBERISH, " ".join(unknown))
    if rewrite.was_pasted:
        yield Flag(FlagCode.PASTED)
    alike = next((each for each in rewrite.of_models if _is_same(rewrite.text, each)), None)
    if alike is not None:
        yield Flag(FlagCode.LIKE_MODEL, alike)


def check_flags(text: str, words_asked: str) -> tuple[Flag, ...]:
    """Return the flag of a planted check whose answer lacks one of ``words_asked``."""
    said = folded_words(text)
    missing = [word for word in folded_words(words_asked) if word not in said]
    return (Flag(FlagCode.CHECK_FAILED, " ".join(missing)),) if missing else ()


def free_command_flags(command: FreeCommand, knows: Knows) -> tuple[Flag, ...]:
    """Return the flags of a free command: it is spam if it is a copy, a repeat, gibberish or a single word."""
    flags: list[Flag] = []
    same = [each for each in (*command.prompts, *command.own) if _is_same(command.text, each)]
    unknown = unknown_words(command.text, knows)
    if same or unknown or len(folded_words(command.text)) < LEAST_WORDS:
        evidence = same[0] if same else " ".join(unknown) or command.text
        flags.append(Flag(FlagCode.SPAM, evidence))
    if command.was_pasted:
        flags.append(Flag(FlagCode.PASTED))
    return tuple(flags)


def unknown_words(text: str, knows: Knows) -> tuple[str, ...]:
    """Return the words that nobody knows where they have more than ``MOST_UNKNOWN`` of the letters; else nothing.

    A text without words is a word that nobody knows.
    """
    words = [word for word in folded_words(text) if not word.isdecimal()]
    if not words:
        return (text.strip() or "–",)
    unknown = [word for word in words if not knows(word)]
    share = sum(map(len, unknown)) / sum(map(len, words))
    return tuple(dict.fromkeys(unknown)) if share > MOST_UNKNOWN else ()


def _least_seconds(rewrite: Rewrite) -> float:
    edits = distance(rewrite.text, rewrite.prompt).edit
    return max(LEAST_SECONDS, edits / MOST_EDITS_A_SECOND)


@lru_cache(maxsize=2**15)  # each new text is compared with earlier ones
def bare_words(text: str) -> str:
    """Return the words of ``text`` without courtesy and articles: who writes the same twice repeats them."""
    words = folded_words(text)
    return " ".join(word for word in words if word not in COURTESY_WORDS) or " ".join(words)


def _is_same(one: str, other: str) -> bool:
    """Return whether two texts are ``ALIKE`` but for courtesy, articles, case and punctuation."""
    return (
        Levenshtein.normalized_similarity(bare_words(one), bare_words(other), score_cutoff=ALIKE)
        >= ALIKE
    )
