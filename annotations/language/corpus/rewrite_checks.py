"""What to tell somebody about their rewrite of a prompt: too close, too far, or an entity is missing.

All of it is advice. The bounds are those of the task by which the paper's corpus was collected
(docs/reference/formats.md, Crowd tables).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

from annotations.language.corpus.distances import distance
from annotations.language.texts import COURTESY_WORDS, folded_words, spellings

# Levenshtein distance over the length of the prompt, and Jaccard distance of the words.
CLOSE_EDITS, CLOSE_WORDS = 0.15, 0.2
FAR_EDITS, FAR_WORDS = 1.0, 0.9
_STEM = 3  # letters by which words of a description are compared: "sitting" and "sit"


class RewriteFault(StrEnum):
    """What a warning is about."""

    TOO_CLOSE = "too_close"
    TOO_FAR = "too_far"
    LOST_ENTITY = "lost_entity"


@dataclass(frozen=True, slots=True)
class Named:
    """An entity of a prompt: what the prompt calls it, and its other names.

    ``is_described`` says that ``text`` is a description; people keep a word or two of it: "pointing to the
    left", "the day of the week".
    """

    text: str
    aliases: tuple[str, ...] = ()
    is_described: bool = False


@dataclass(frozen=True, slots=True)
class RewriteWarning:
    """``evidence`` is the name that is missing, or the number of edits."""

    code: RewriteFault
    evidence: str


def check_rewrite(
    rewrite: str, prompt: str, entities: Sequence[Named]
) -> tuple[RewriteWarning, ...]:
    """Return what to tell the writer: at most one warning about distance, then one for each lost entity.

    Too close is fewer edits than ``CLOSE_EDITS`` of the prompt's characters, or a smaller Jaccard distance than
    ``CLOSE_WORDS``; too far is more than ``FAR_EDITS`` or ``FAR_WORDS``. An empty rewrite gives nothing.
    """
    if not rewrite.strip():
        return ()
    apart = distance(rewrite, prompt)
    edits = apart.edit / max(len(prompt), 1)
    warnings: list[RewriteWarning] = []
    if edits < CLOSE_EDITS or apart.jaccard < CLOSE_WORDS:
        warnings.append(RewriteWarning(RewriteFault.TOO_CLOSE, str(apart.edit)))
    elif edits > FAR_EDITS or apart.jaccard > FAR_WORDS:
        warnings.append(RewriteWarning(RewriteFault.TOO_FAR, str(apart.edit)))
    lost = lost_entities(rewrite, entities)
    return (*warnings, *(RewriteWarning(RewriteFault.LOST_ENTITY, name) for name in lost))


def lost_entities(rewrite: str, entities: Sequence[Named]) -> tuple[str, ...]:
    """Return the names of ``entities`` that ``rewrite`` does not mention, each once, in their order.

    A mention is the name, an alias, or a plural or singular of one, as whole words. Case, accents, hyphens,
    blanks inside a name ("livingroom") and a possessive 's do not matter. Of a description, one word that says
    something is enough.
    """
    words = folded_words(rewrite)
    lost = (entity.text for entity in entities if not _is_mentioned(words, entity))
    return tuple(dict.fromkeys(lost))


def _is_mentioned(words: Sequence[str], entity: Named) -> bool:
    if any(_mentions(words, name) for name in _names_of(entity)):
        return True
    if not entity.is_described:
        return False
    stems = {word[:_STEM] for word in words if word not in COURTESY_WORDS}
    described = {word[:_STEM] for word in folded_words(entity.text) if word not in COURTESY_WORDS}
    return bool(stems & described)


def _names_of(entity: Named) -> Iterator[str]:
    for name in (entity.text, *entity.aliases):
        yield name
        yield from spellings(name)


def _mentions(words: Sequence[str], name: str) -> bool:
    """Return whether a run of ``words``, written as one, is ``name`` written as one."""
    joined = "".join(folded_words(name))
    for start in range(len(words)):
        rest = joined
        for word in words[start:]:
            if not rest or not rest.startswith(word):
                break
            rest = rest[len(word) :]
        if not rest:
            return True
    return not joined
