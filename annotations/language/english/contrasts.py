"""Words that contradict a predicate: data for the audit of labels."""

from __future__ import annotations

# Predicate → the words and phrases that say it.
PREDICATE_WORDS = {
    "male": [
        "male",
        "males",
        "man",
        "men",
        "boy",
        "boys",
        "gentleman",
        "gentlemen",
        "guy",
        "guys",
        "dude",
        "dudes",
    ],
    "female": [
        "female",
        "females",
        "woman",
        "women",
        "girl",
        "girls",
        "lady",
        "ladies",
        "gal",
        "gals",
    ],
    "lying": ["lying", "laying", "lies"],
    "sitting": ["sitting", "seated", "sits"],
    "standing": ["standing", "stands", "stood"],
    "biggest": ["biggest"],
    "largest": ["largest"],
    "smallest": ["smallest", "tiniest", "littlest"],
    "heaviest": ["heaviest"],
    "lightest": ["lightest"],
    "thinnest": ["thinnest", "slimmest", "skinniest"],
    "leftmost": ["leftmost", "left-most"],
    "rightmost": ["rightmost", "right-most"],
    "left_of": ["left of", "to the left"],
    "right_of": ["right of", "to the right"],
    "above": ["above"],
    "below": ["below", "beneath", "underneath"],
}
# Predicates of which no two mean the same thing; a word of one contradicts the others.
CONTRASTS = (
    ("male", "female"),
    ("lying", "sitting", "standing"),
    ("biggest", "largest", "smallest", "heaviest", "lightest", "thinnest"),
    ("leftmost", "rightmost"),
    ("left_of", "right_of"),
    ("above", "below"),
)
# Predicates that people use for one another: a word of one is weak evidence against the others.
NEAR_SYNONYMS = (("biggest", "largest"),)
NEGATIONS = frozenset(("not", "no", "non", "never", "isn't", "aren't", "without"))
