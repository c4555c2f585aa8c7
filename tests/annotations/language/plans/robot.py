"""A robot in a small house, and talks with it."""

from __future__ import annotations

from annotations.language.forms import read_form
from annotations.language.plans import DialogueManager, DialogueState
from tests.annotations.language.sample_ontology import HOME

ROBOT = DialogueManager(HOME, {})
PUT = '(put (λ$1:e (is_a $1 "<object>") (at $1 "<location>")) "<location>")'
BRING = '(bring (λ$1:e (is_a $1 "<object>")))'
UNCLEAR = "grab the tea on the shelf and put it on the stool"


def begin(text: str, form: str, is_sure: bool = True) -> DialogueState:
    return ROBOT.begin(read_form(form), ROBOT.anonymizer.anonymize(text), is_sure)


def talk(text: str, form: str, *answers: str) -> DialogueState:
    state = begin(text, form)
    for answer in answers:
        state = ROBOT.reply(state, answer)
    return state
