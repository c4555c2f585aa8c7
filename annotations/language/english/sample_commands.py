"""Commands with the forms that they ask for: what English alone tells about which words go where."""

from __future__ import annotations

# Words that stand for somebody or something said before.
PERSON_WORDS = frozenset(
    (
        "person", "man", "woman", "boy", "girl", "guest", "someone", "somebody", "him", "her",
        "them", "he", "she", "they", "who", "people",
    )
)  # fmt: skip
THING_WORDS = frozenset(
    (
        "it", "object", "item", "thing", "one", "objects", "items", "things", "which",
    )
)  # fmt: skip
DETERMINERS = frozenset(
    (
        "the", "a", "an", "some", "my", "your", "our", "his", "her", "their", "this", "that", "any",
    )
)  # fmt: skip
# Verbs of which "to" says where somebody goes first, rather than where a thing ends up.
GOING_WORDS = frozenset(
    (
        "go", "going", "walk", "head", "drive", "navigate", "proceed", "travel", "get", "run",
        "come", "move", "over", "back",
    )
)  # fmt: skip
# Words that no name of a thing contains: a phrase ends before them.
BOUNDARIES = frozenset(
    (
        "and", "or", "but", "then", "from", "to", "into", "onto", "on", "in", "at", "of", "for",
        "with", "by", "near", "under", "behind", "beside", "above", "below", "over", "off", "out",
        "up", "down", "back", "away", "here", "there", "is", "are", "was", "be", "who", "that",
        "which", "where", "when", "while", "please", "me", "you", "him", "her", "them", "it", "us",
        "i", "we", "he", "she", "they", "now", "again", "after", "before", "because", "if", "so",
    )
)  # fmt: skip

_PUT = '(put (λ$1:e (is_a $1 "<object0>") (at $1 "<location1>")) "<location2>")'
_GUIDE = '(guide (λ$1:e (person $1) (name $1 "<name0>") (at $1 "<location1>")) "<location2>")'
_GUIDE_ROOM = '(guide (λ$1:e (person $1) (name $1 "<name0>") (at $1 "<room1>")) "<room2>")'
_BRING = (
    '(bring (λ$1:e (is_a $1 "<object0>") (at $1 "<location1>")) '
    '(λ$1:e (person $1) (name $1 "<name2>") (at $1 "<location3>")))'
)
_SAY = '(say "<whattosay0>" (λ$1:e (person $1) (name $1 "<name1>") (at $1 "<location2>")))'
_POUR = '(pour (λ$1:e (is_a $1 "<object0>")) (λ$1:e (is_a $1 "<object1>")))'
_PUT_IN = '(put (λ$1:e (is_a $1 "<object0>")) (λ$1:e (is_a $1 "<object1>")))'
_INTRODUCE = (
    '(introduce (λ$1:e (person $1) (name $1 "<name0>")) (λ$1:e (person $1) (name $1 "<name1>")))'
)
_BESIDE = '(bring (λ$1:e (is_a $1 "<object0>") (next_to $1 (λ$2:e (is_a $2 "<object1>")))))'

SAMPLE_COMMANDS: tuple[tuple[str, str], ...] = (
    ("move the <object0> from the <location1> to the <location2>", _PUT),
    ("take the <object0> from the <location1> to the <location2>", _PUT),
    ("from the <location1> carry the <object0> to the <location2>", _PUT),
    ("get the <object0> at the <location1> and put it on the <location2>", _PUT),
    ("grab the <object0> off the <location1> and place it onto the <location2>", _PUT),
    ("put the <object0> that is on the <location1> on the <location2>", _PUT),
    ("on the <location2> put the <object0> from the <location1>", _PUT),
    ("the <object0> on the <location1> should be moved to the <location2>", _PUT),
    ("go to the <location1> find the <object0> and put it on the <location2>", _PUT),
    ("go to the <location1> get the <object0> and take it to the <location2>", _PUT),
    ("guide <name0> from the <location1> to the <location2>", _GUIDE),
    ("meet <name0> at the <location1> and take them to the <location2>", _GUIDE),
    ("lead <name0> who is at the <location1> to the <location2>", _GUIDE),
    ("take <name0> to the <location2> you will find them at the <location1>", _GUIDE),
    ("guide <name0> from the <room1> to the <room2>", _GUIDE_ROOM),
    ("go to the <location1> meet <name0> and take them to the <location2>", _GUIDE),
    ("find <name0> in the <room1> and take them to the <room2>", _GUIDE_ROOM),
    ("bring the <object0> from the <location1> to <name2> at the <location3>", _BRING),
    ("bring <name2> at the <location3> the <object0> from the <location1>", _BRING),
    ("give <name2> the <object0> on the <location1> they are at the <location3>", _BRING),
    ("take the <object0> on the <location1> to <name2> who is near the <location3>", _BRING),
    ("tell <name1> at the <location2> <whattosay0>", _SAY),
    ("pour the <object0> into the <object1>", _POUR),
    ("fill the <object1> with the <object0>", _POUR),
    ("put the <object0> into the <object1>", _PUT_IN),
    ("put the <object0> in the <object1>", _PUT_IN),
    ("introduce <name0> to <name1>", _INTRODUCE),
    ("bring me the <object0> next to the <object1>", _BESIDE),
    ("bring me the <object0> by the <object1>", _BESIDE),
)
