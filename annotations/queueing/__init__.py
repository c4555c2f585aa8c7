"""Verbs: say what is to be done and why, give it to one person at a time, and record what came of it.

``enqueue`` adds items and ``refill`` the ones that rows call for. ``next_item`` gives a person the item
they hold or the most urgent free one, under a lease; ``finish``, ``skip``, ``give_back`` and ``take_back``
end and reopen their part of it; ``settle`` and ``unsettle`` do so for what is decided elsewhere.
``send_examples`` asks about what examples of splits were copied from. A share
of the utterances goes to two people, who do not see each other's labels; where these differ a third person
compares them. ``answer`` labels an utterance and ends the part in one transaction. ``ask_about`` asks for
a look at a row, ``assign_first`` gives several items to one person.
"""

from annotations.queueing.answering import answer, part_in, take_answer_back
from annotations.queueing.asking import ASKABLE, ask_about, assign_first
from annotations.queueing.enqueuing import WantedItem, enqueue
from annotations.queueing.finishing import finish, give_back, skip
from annotations.queueing.giving import (
    NoLongerYours,
    NotForThem,
    Wanted,
    assign,
    held_item,
    next_item,
    take,
    withdraw,
)
from annotations.queueing.sending import send_examples
from annotations.queueing.settling import settle, unsettle
from annotations.queueing.shares import DOUBLE_KINDS, set_share, shares_of

__all__ = [
    "ASKABLE",
    "DOUBLE_KINDS",
    "NoLongerYours",
    "NotForThem",
    "Wanted",
    "WantedItem",
    "answer",
    "ask_about",
    "assign",
    "assign_first",
    "enqueue",
    "finish",
    "give_back",
    "held_item",
    "next_item",
    "part_in",
    "send_examples",
    "set_share",
    "settle",
    "shares_of",
    "skip",
    "take",
    "take_answer_back",
    "unsettle",
    "withdraw",
]
