"""Lines added later lengthen what a world says: what changes, what is understood then, and what stays as it is."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

from annotations.labelling.storing_examples import store_examples
from annotations.language.grammar import CHECK_STEPS, Budget
from annotations.language.induction import propose
from annotations.models import Production, SemanticTemplate, World
from annotations.rows.history import history_of
from annotations.rows.known_world import known_world_of


@dataclass(frozen=True)
class Case:
    """``understood`` are commands that nobody has said with their heads; ``productions`` and ``templates`` are some
    lines as they stand in the end, ``changes`` how many words are lengthened."""

    stored: str
    later: str
    understood: dict[str, str]
    changes: int = 1
    productions: tuple[str, ...] = ()
    templates: tuple[str, ...] = ()
    unknown: tuple[str, ...] = field(default=())


CASES = {
    "a hospital's word that stands literally": Case(
        "disinfect [room nine](room)\ngo to [room nine]",
        "sanitize [room four](room) = disinfect",
        {"sanitize <room>": "disinfect", "disinfect <room>": "disinfect", "go to <room>": "go"},
        productions=("$disinfect = disinfect | sanitize",),
        templates=("$disinfect {room} = (disinfect {room})",),
    ),
    "a warehouse's word that varies already": Case(
        "stack the [crate](item) on the [pallet](place)\npile the [crate] on the [pallet] = stack",
        "heap the [crate] on the [pallet] = stack\nload the [crate] on the [pallet] = stack",
        {"load the <item> on the <place>": "stack", "pile the <item> on the <place>": "stack"},
        productions=("$stack = stack | pile | heap | load",),
        templates=("$stack the {item} on the {place} = (stack {item} {place})",),
    ),
    "a library's verb of two words": Case(
        "shelve the [atlas](book) in the [reading room](place)",
        "put away the [atlas] in the [reading room] = shelve",
        {"put away the <book> in the <place>": "shelve"},
        productions=("$shelve = shelve | put away",),
    ),
    "a farm's word for all that its action says": Case(
        "feed the [goats](animal)\nfeed the [goats] in the [barn](place)",
        "fodder the [cows](animal) = feed",
        {"fodder the <animal> in the <place>": "feed"},
        productions=("$feed = feed | fodder",),
        templates=(
            "$feed the {animal} = (feed {animal})",
            "$feed the {animal} in the {place} = (feed {animal} {place})",
        ),
    ),
    "a word in the middle": Case(
        "take a picture of the [cow](animal)",
        "take a photo of the [cow] = take_picture",
        {"take a photo of the <animal>": "take_picture"},
        productions=("$picture = picture | photo",),
    ),
    "two words of one line that both vary": Case(
        "inspect the [pump](device) carefully\ncheck the [pump] carefully = inspect_carefully"
        "\ninspect the [pump] thoroughly = inspect_carefully",
        "examine the [pump] thoroughly = inspect_carefully",
        {"examine the <device> carefully": "inspect_carefully"},
        productions=("$inspect = inspect | check | examine", "$carefully = carefully | thoroughly"),
    ),
    "a new command uses the words that vary": Case(
        "stack the [crate](item) on the [pallet](place)\npile the [crate] on the [pallet] = stack",
        "stack the [crate] on the [pallet] at [noon](time)",
        {"pile the <item> on the <place> at <time>": "stack"},
        changes=0,
    ),
    "a new command and its variant": Case(
        "stack the [crate](item) on the [pallet](place)",
        "stack the [crate] on the [pallet] at [noon](time)\n"
        "heap the [crate] on the [pallet] at [noon] = stack",
        {"heap the <item> on the <place> at <time>": "stack"},
        changes=0,
    ),
    "an order of words of its own is a template of its own": Case(
        "feed the [goats](animal) with [hay](food)",
        "give [hay] to the [goats] = feed",
        {"give <food> to the <animal>": "feed_to"},
        changes=0,
        templates=("feed the {animal} with {food} = (feed {animal} {food})",),
    ),
    "another verb is another action": Case(
        "prune the [roses](plant)",
        "spray the [roses]",
        {"spray the <plant>": "spray"},
        changes=0,
    ),
    "what somebody refuses": Case(
        "disinfect [room nine](room)\ndisinfect [room nine] at [noon](time)",
        "sanitize [room four](room) = disinfect\n# sanitize is not disinfect",
        {"sanitize <room>": "disinfect"},
        changes=0,
        templates=("disinfect {room} = (disinfect {room})", "sanitize {room} = (disinfect {room})"),
        unknown=("sanitize <room> at <time>",),
    ),
    "what somebody refuses of words that vary": Case(
        "stack the [crate](item)\npile the [crate] = stack",
        "heap up the [crate] = stack\n# [heap up] is not $stack",
        {"heap up the <item>": "stack"},
        changes=0,
        productions=("$stack = stack | pile",),
    ),
    "an article more or less": Case(
        "water the [roses](plant)",
        "irrigate [roses] = water",
        {"irrigate the <plant>": "water"},
        productions=("$water = water | irrigate",),
    ),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_later_lines_lengthen_what_is_stored(world, admin, case):
    store_examples(world, case.stored, admin)
    proposal = propose(case.later, known_world_of(world))
    assert len(proposal.changes) == case.changes
    stored = store_examples(world, case.later, admin)
    assert bool(stored.lengthened) == bool(case.changes)
    assert_understands(world, case.understood, case.unknown)
    assert {*case.productions} <= {*map(str, Production.objects.all())}
    assert {*case.templates} <= {*map(str, SemanticTemplate.objects.all())}
    assert not SemanticTemplate.objects.with_problems()
    again = propose(f"{case.stored}\n{case.later}", known_world_of(world))
    assert not again.templates and not again.changes


def assert_understands(world, understood, unknown=()):
    chart = known_world_of(World.objects.get(pk=world.pk)).chart
    heads = {
        said: [each.form_text.split()[1] for each in chart.parse(said, Budget(CHECK_STEPS))][:1]
        for said in (*understood, *unknown)
    }
    assert heads == {said: [head] for said, head in understood.items()} | {
        said: [] for said in unknown
    }


def test_a_change_says_what_was_and_what_becomes_of_it(world, admin):
    store_examples(world, CASES["a hospital's word that stands literally"].stored, admin)
    (change,) = propose("sanitize [room nine] = disinfect", known_world_of(world)).changes
    assert [(each.kind, each.before, each.after) for each in change.edits] == [
        ("production", "", "$disinfect = disinfect | sanitize"),
        ("production", "$Main = disinfect {room}", "$Main = $disinfect {room}"),
        (
            "template",
            "disinfect {room} = (disinfect {room})",
            "$disinfect {room} = (disinfect {room})",
        ),
    ]
    assert change.lines == (1,)
    assert change.comments == ("# sanitize is not disinfect",)


def test_what_changes_has_a_history(world, admin):
    store_examples(world, "disinfect [room nine](room)", admin)
    store_examples(world, "sanitize [room nine] = disinfect", admin)
    template = SemanticTemplate.objects.get()
    versions = history_of(SemanticTemplate).filter(id=template.pk).order_by("history_id")
    assert [(each.version, each.pattern, each.history_user) for each in versions] == [
        (1, "disinfect {room}", admin),
        (2, "$disinfect {room}", admin),
    ]
    labels = dict(world.utterances.values_list("text", "logical_form"))
    assert labels["sanitize room nine"] == '( disinfect " <room> " )'


def test_a_new_verb_may_be_an_action_of_the_world(world, admin):
    store_examples(world, "disinfect [room nine](room)\ngo to [room nine]", admin)
    lines = "sanitize [room nine]"
    known = known_world_of(world)
    assert [(each.first, each.second, each.comment) for each in propose(lines, known).doubts] == [
        ("sanitize", "disinfect", "# sanitize is not disinfect")
    ]
    assert not propose(f"{lines}\n# disinfect is not sanitize", known).doubts


HOUSEHOLD = [
    # a choice in a pattern becomes longer, with the production of the same words
    ("pass me the [apple] = bring", "pass me the <object>"),
    # a nonterminal becomes longer, in all that says it
    (
        "fish up the [apple] and bring it here = bring",
        "fish up the <object> and bring it over to me",
    ),
]


@pytest.mark.parametrize("line, said", HOUSEHOLD)
def test_templates_of_a_shipped_world_are_lengthened(household, admin, line, said):
    known = known_world_of(household)
    proposal = propose(line, known)
    assert proposal.changes and not proposal.templates
    before = {*SemanticTemplate.objects.values_list("pk", flat=True)}
    outside = SemanticTemplate.objects.with_problems().count()
    store_examples(household, line, admin)
    assert {*SemanticTemplate.objects.values_list("pk", flat=True)} == before
    assert SemanticTemplate.objects.with_problems().count() == outside
    assert_understands(household, {said: "bring"})
    again = propose(line, known_world_of(World.objects.get(pk=household.pk)))
    assert again.understood == (1,) and not again.changes


def test_english_of_an_action_that_the_world_has_is_changed_where_somebody_writes_it(world, admin):
    store_examples(world, "water the [roses](plant)\nwater the [basil](plant)", admin)
    before = world.predicates.get(name="water")
    store_examples(world, "water the [roses]\n# water: give water to {1}", admin)
    after = world.predicates.get(name="water")
    assert (
        (after.gloss, after.signatures)
        == ("give water to {1}", before.signatures)
        != (
            before.gloss,
            before.signatures,
        )
    )
