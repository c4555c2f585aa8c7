import json
import re
from collections import Counter
from pathlib import Path
from random import Random

import pytest

from annotations.language.corpus import Rewording
from annotations.language.forms import CLASS_TOKEN, read_form
from annotations.language.texts import KNOWN_PATTERNS, REWORDED_PATTERNS
from annotations.language.world import infer_signatures
from annotations.language.world.gloss_patterns import read_pattern

STARTER = Path(__file__).resolve().parents[4] / "annotations" / "starter"
PUBLISHED = (
    '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )',
    '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) ( lambda $1 e ( person $1 ) ( name $1 " <name> " ) ) )',
    '( guide ( lambda $1 e ( person $1 ) ( name $1 " <name> " ) ( at $1 " <location> " ) ) " <room> " )',
    '( say ( count ( lambda $1 e ( is_a $1 " <category> " ) ( at $1 " <location> " ) ) ) )',
    '( say " <whattosay> " )',
    '( go " <location> " )',
)


def reworder(*forms):
    return Rewording(infer_signatures(map(read_form, forms)))


@pytest.mark.parametrize("form", PUBLISHED)
def test_a_rewording_names_what_the_form_names(form):
    rewording, random = reworder(form), Random(1)
    said = {rewording.say(form, random) for _ in range(200)}
    assert len(said) > 20
    for text in said:
        assert Counter(CLASS_TOKEN.findall(text)) == Counter(CLASS_TOKEN.findall(form)), text
        assert not re.search(r"[{}‹›_]|the <name>|  ", text), text


def test_the_same_numbers_draw_the_same_words():
    rewording = reworder(*PUBLISHED)
    first, second = ([rewording.say(each, Random(7)) for each in PUBLISHED] for _ in range(2))
    assert first == second


def test_steps_of_a_sequence_are_said_in_order_each_in_words_of_its_own():
    go, find = '( go " <room> " )', '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'
    form = f"( sequence {go} {find} )"
    predicates = infer_signatures(map(read_form, (go, find, form)))
    random = Random(3)
    for _ in range(50):
        text = Rewording(predicates).say(form, random)
        assert text.index("<room>") < text.index("<object>")


@pytest.mark.parametrize("pattern", REWORDED_PATTERNS)
def test_other_words_say_the_same_of_the_same_arguments(pattern):
    (meant,) = read_pattern(pattern)
    wanted = {slot.place for slot in meant.slots}
    # A text need not be said: "throw it away" is into the trash.
    texts = {slot.place for slot in meant.slots if slot.kind == "text"}
    for other in REWORDED_PATTERNS[pattern]:
        (said,) = read_pattern(other)
        found = {slot.place for slot in said.slots}
        assert wanted - texts <= found <= wanted, other
        assert said.is_nested == meant.is_nested, other
        assert ("_" in pattern) >= ("_" in other), other


def test_every_pattern_is_one_that_a_gloss_has():
    shipped = [
        predicate["gloss"]
        for file in STARTER.glob("*/predicates.json")
        for predicate in json.loads(file.read_text(encoding="utf-8"))
    ]
    assert shipped
    known = {
        alternative.strip()
        for gloss in (*KNOWN_PATTERNS.values(), *shipped)
        for alternative in gloss.split("|")
    }
    assert set(REWORDED_PATTERNS) <= known
