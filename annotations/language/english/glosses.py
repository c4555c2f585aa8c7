"""How to say predicates and classes: data for the English sentence of a form."""

from __future__ import annotations

NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
# Entity class → the noun for it, if it is a different word.
CLASS_WORDS = {"whattosay": "sentence"}
PLURALS = {"person": "people"}

# Predicates that are prepositions: "that is at …".
RELATIONS = frozenset(
    ["at", "in", "on", "near", "above", "below", "behind", "under", "beside", "inside", "over"]
)
# Kind of an argument → the preposition before it.
PREPOSITIONS = {
    "lambda": "for",
    "name": "for",
    "location": "at",
    "room": "in",
}

# The predicates of the published corpus and similar ones.
KNOWN_PATTERNS = {
    "bring": "bring me {1} | bring {1} to {2:lambda} | bring me {1} from {2}",
    "put": "take {1} and put it on {2} | take {1} and put it somewhere{2=UNKNOWN}",
    "pour": "pour {1} into {2}",
    "find": "find {1} | find {2} {1:plural}",
    "follow": "follow {1} | follow someone{1=UNKNOWN} | follow {1} to {2}",
    "go": "go to {1} | go somewhere{1=UNKNOWN}",
    "guide": "guide {1} | guide {1} to {2} | guide {1} somewhere{2=UNKNOWN} | "
    "guide {1} back{2=current}",
    "say": "tell me {1} | say {1} | say {1} to {2} | {1:form} for {2} | tell {2} {1:text}",
    "answer": "answer {1} | answer {1} for {2}",
    "count": "count {1:plural} | = the number of {1:plural}",
    "sequence": "{*}",
    "and": "{*}",
    "person": "person",
    "is_a": "{2} | object of {2:category}",
    "name": "_ named {2:text} | _ with the given {2:name}",
    "at": "_ that is at {2} | _ that is in {2:room}",
    **dict.fromkeys(("is", "gesture"), "_ that is {2:text} | _ that is making {2}"),
    "male": "male _",
    "female": "female _",
    "lying": "_ that is lying down",
    "sitting": "_ that is sitting",
    "standing": "_ that is standing",
    "leftmost": "leftmost _ | leftmost _ at {2}",
    "rightmost": "rightmost _ | rightmost _ at {2}",
    "left_of": "_ to the left of {2}",
    "right_of": "_ to the right of {2}",
    "on_top_of": "_ on top of {2}",
    "above": "_ above {2}",
    "below": "_ under {2}",
    "behind": "_ behind {2}",
    **{
        name: f"{name} _ | {{2}} {name} _"
        for name in ("biggest", "largest", "smallest", "heaviest", "lightest", "thinnest")
    },
}
