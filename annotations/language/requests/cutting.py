"""Cut an utterance that holds several commands into its commands.

A cut is tried wherever people join commands: at a sign, at "and then". Which joints lie between two commands and which
inside one ("take the tea and bring it to me") only a parser can tell, so the caller judges the pieces. The cut is the
best path over the joints, by dynamic programming.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence

from annotations.language.english import JOINT_OPENINGS, JOINTS

MOST_COMMANDS = 3  # as many as a referee gives at once
MOST_JOINTS = 16  # in an utterance, so at most 153 pieces; one with more is not cut

Judge = Callable[[Sequence[str]], Sequence[float | None]]
"""Returns for each piece how well it is understood as one command; None for one that is not."""


def _phrases(phrases: Iterable[str]) -> str:
    return "|".join(re.escape(each) for each in sorted(phrases, key=len, reverse=True))


# Possessive, and only from where blanks or signs begin: linear for every text.
_SIGN = r"(?<![\s.;:,!?])\s*+[.;:,!?]++\s++"
_WORDS = rf"(?:(?:{_phrases(JOINTS)})\b(?:,?\s++))"
_NUMBER = r"(?:\(?[1-9][.)]\s++)"
_JOINT = re.compile(
    rf"(?:{_SIGN}(?:{_WORDS}|{_NUMBER})*+|(?<!\s)\s++(?:{_WORDS}|{_NUMBER})++)", re.IGNORECASE
)
_OPENING = re.compile(
    rf"\s*+(?:(?:{_phrases((*JOINT_OPENINGS, *JOINTS))})\b[\s,:.]*+|{_NUMBER})++", re.IGNORECASE
)
_SIGNS = " .,;:!?"  # of the end of a command


def cut_commands(utterance: str, judge: Judge, most: int = MOST_COMMANDS) -> tuple[str, ...]:
    """Return the commands of an utterance, in its order.

    An utterance that ``judge`` understands as it is, is one command. Of the cuts all of whose pieces are understood,
    the one with the fewest counts, and of these the one with the highest sum. Where there is none, the utterance
    comes back whole.
    """
    [whole] = judge([utterance])
    if whole is not None:
        return (utterance,)
    opening = _OPENING.match(utterance)
    starts, ends = [opening.end() if opening else 0], []
    for joint in _JOINT.finditer(utterance, starts[0]):
        ends.append(joint.start())
        starts.append(joint.end())
    ends.append(len(utterance))
    if len(ends) > MOST_JOINTS + 1:
        return (utterance,)
    places = [(first, last) for first in range(len(starts)) for last in range(first, len(ends))]
    pieces = {
        (first, last): utterance[starts[first] : ends[last]].rstrip(_SIGNS)
        for first, last in places
        if starts[first] < ends[last]
    }
    scores = dict(zip(pieces, judge(list(pieces.values())), strict=True))
    best = _best_path(scores, len(ends), most)
    return tuple(pieces[place] for place in best) or (utterance,)


def _best_path(
    scores: dict[tuple[int, int], float | None], number: int, most: int
) -> tuple[tuple[int, int], ...]:
    """Return the fewest pieces from the first joint to the last, with the highest sum; none where there are none."""
    reached: dict[int, tuple[float, tuple[tuple[int, int], ...]]] = {0: (0.0, ())}
    for _ in range(most):
        further: dict[int, tuple[float, tuple[tuple[int, int], ...]]] = {}
        for first, (total, path) in reached.items():
            for last in range(first, number):
                score = scores.get((first, last))
                if score is None:
                    continue
                found = total + score, (*path, (first, last))
                if last + 1 not in further or found[0] > further[last + 1][0]:
                    further[last + 1] = found
        if number in further:
            return further[number][1]
        reached = further
    return ()
