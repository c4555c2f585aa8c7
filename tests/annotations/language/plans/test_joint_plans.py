from __future__ import annotations

import time
from collections import Counter
from collections.abc import Sequence
from functools import cache
from itertools import groupby, pairwise, starmap

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from annotations.language.plans import (
    AFTER_COMMANDS,
    Distances,
    EffectKind,
    JointPlan,
    NoteKind,
    Reason,
    RecipeBook,
    RecipeTrouble,
    TaskPlan,
    TaskStep,
    TooManyCommands,
    WrongDistance,
    default_book,
    join,
    joint_plan_schema,
    joint_plan_schema_text,
    read_book,
    say_length,
    spoken,
    to_behavior_tree,
)
from annotations.language.plans.situation import Place, Somewhere
from tests.annotations.language.plans.task_plans import calls, codes, task_plan
from tests.annotations.language.plans.xml_schema import xml_schema
from tests.annotations.language.random_commands import commands

JSON_SCHEMA = jsonschema.Draft202012Validator(joint_plan_schema())
MOVING = (EffectKind.MOVES, EffectKind.ACCOMPANIES)

TEA = '(λ$1:e (is_a $1 "tea") (at $1 "attic"))'
KNIFE = '(λ$1:e (is_a $1 "knife") (at $1 "attic"))'
ADA = '(λ$1:e (person $1) (name $1 "Ada") (at $1 "stool"))'
COUNT = '(say (count (λ$1:e (is_a $1 "drinks") (at $1 "{}"))))'


BOOK = default_book()
WITHOUT_WAY_BACK = RecipeBook(
    BOOK.primitives,
    tuple(each for each in BOOK.recipes if each.pattern.action != AFTER_COMMANDS),
)
PRIMITIVES = "\n".join(map(str, BOOK.primitives))


def notes_of(joint: JointPlan, code: NoteKind) -> list[tuple[int, ...]]:
    return [each.commands for each in joint.notes if each.code is code]


def joined(*forms: str, distances: Distances | None = None) -> JointPlan:
    return join([task_plan(form) for form in forms], default_book(), distances)


def has(step: TaskStep, *kinds: EffectKind) -> bool:
    return any(step.primitive.effect(kind) for kind in kinds)


def places_after(steps: tuple[TaskStep, ...], command: int = 0) -> list[Place]:
    """Where the robot is at the beginning and after each step."""
    places = [OPERATOR]
    for step in steps:
        somewhere = Somewhere(step.number + 1000 * command)
        place = somewhere if step.place is None else step.place
        places.append(place if has(step, *MOVING) else places[-1])
    return places


def walk(steps: tuple[TaskStep, ...], distances: Distances) -> float:
    """The walk of a plan, from its steps."""
    return sum(starmap(distances.between, pairwise(places_after(steps))))


OPERATOR = task_plan('(bring (λ$1:e (is_a $1 "tea")))').steps[0].place


def test_a_place_is_visited_once_for_two_commands():
    joint = joined(f'(put {TEA} "tea room")', '(go "tea room")', COUNT.format("attic"))
    assert (joint.length, joint.length_before) == (3, 4)  # in rooms; it ends where it began
    shared = [each for each in joint.interleavings if each.reason is Reason.SHARED_VISIT]
    assert [each.commands for each in shared] == [(1, 3), (1, 2)]
    assert "attic" in shared[0].message and "tea room" in shared[1].message
    assert Reason.SHORTER in [each.reason for each in joint.interleavings]


def test_the_robot_comes_back_once_to_tell_two_results():
    joint = joined(COUNT.format("attic"), COUNT.format("stool"))
    assert (joint.length_before, joint.length) == (4, 2.5)
    assert calls(joint.plan).count("go_to(operator)") == 1
    reasons = [each.reason for each in joint.interleavings]
    assert reasons == [Reason.SHARED_VISIT, Reason.SAME_ROOM, Reason.SHORTER]
    assert spoken(joint.plan).count("the number of the drinks in the attic") == 1


def test_who_is_guided_somewhere_shares_the_way_there():
    joint = joined(f"(bring {TEA})", f'(guide {ADA} "attic")')
    assert joint.plan.steps[2].action == "guide" and joint.serves[2] == (1, 2)
    reasons = [(each.reason, each.commands) for each in joint.interleavings]
    assert reasons[0] == (Reason.SHARED_VISIT, (1, 2))


def test_one_thing_is_carried_at_a_time():
    joint = joined(f"(bring {TEA})", f"(bring {KNIFE})")
    assert joint.length == joint.length_before == 4
    assert codes(joint.plan) == []
    assert not joint.interleavings


def test_a_command_that_keeps_what_it_takes_comes_last():
    joint = joined(f"(take {TEA})", f"(bring {KNIFE})")
    assert [each.commands for each in joint.interleavings] == [(1, 2)]
    assert joint.interleavings[0].reason is Reason.HANDS
    assert [each.action for each in joint.plan.steps[-2:]] == ["pick_up", "go_to"]
    assert codes(joint.plan) == []


def test_two_commands_that_keep_things_are_a_problem():
    joint = joined(f"(take {TEA})", f"(take {KNIFE})")
    assert codes(joint.plan) == [RecipeTrouble.HANDS_FULL]


def test_somebody_who_has_a_name_is_found_once():
    joint = joined(f'(say "a joke" {ADA})', f"(greet {ADA})")
    assert " ".join(calls(joint.plan)) == (
        "go_to(stool) find_person(Ada) say(a joke, Ada) greet(Ada) go_to(operator)"
    )
    assert joint.serves == ((1, 2), (1, 2), (1,), (2,), (1, 2))


def test_two_people_and_two_things_in_the_same_words_are_found_twice():
    person = '(λ$1:e (person $1) (at $1 "stool"))'
    joint = joined(f"(greet {person})", f'(say "a joke" {person})', f"(open {TEA})")
    assert calls(joint.plan).count("find_person(person)") == 2


def test_questions_are_asked_first():
    joint = joined('(go "attic")', '(go "stool")', "(go UNKNOWN)")
    assert joint.plan.steps[0].action == "ask_operator"
    assert joint.serves[0] == (3,)


def test_a_conversation_and_a_walk_with_somebody_are_not_interrupted():
    talk = f'(sequence (follow {ADA}) (say "a joke" them) (guide them "tea room") (greet them))'
    joint = joined(talk, COUNT.format("attic"), f"(bring {TEA})")
    commands_in_turn = [command for command, _ in groupby(each[0] for each in joint.serves)]
    assert commands_in_turn.count(1) == 1


def test_the_table_of_distances_decides():
    near = {("operator", "attic"): 1.0, ("operator", "tea room"): 1.0, ("attic", "tea room"): 9.0}
    far = {("operator", "attic"): 9.0, ("operator", "tea room"): 9.0, ("attic", "tea room"): 1.0}
    forms = COUNT.format("attic"), COUNT.format("tea room")
    assert joined(*forms, distances=Distances(near)).length == 4
    assert joined(*forms, distances=Distances(far)).length == 19
    assert joined(COUNT.format("stool"), distances=Distances(near)).length == 2  # by its room


@pytest.mark.parametrize(
    "rows",
    [
        [("a", "b", -1.0)],
        [("a", "b", float("nan"))],
        [("a", "b", 1.0), ("b", "a", 2.0)],
        [("a", "a", 1.0)],
    ],
)
def test_a_table_without_sense_is_refused(rows):
    with pytest.raises(WrongDistance):
        Distances.of_rows(rows)


def test_a_table_has_rows():
    assert Distances.of_rows([("a", "b", 1.0), ("b", "a", 1.0)]).table[("a", "b")] == 1
    assert Distances.of_rows([("a", "b", 0.0), ("a", "a", 0.0)]).table[("a", "b")] == 0


def test_a_way_inside_a_room_that_the_table_lacks_is_none():
    far = Distances({("operator", "attic"): 3.0})
    assert joined('(go "attic")', '(go "stool")', distances=far).length == 6


def test_more_than_three_commands_are_refused():
    with pytest.raises(TooManyCommands):
        joined(*['(go "attic")'] * 4)


def test_no_command_is_no_plan():
    assert joined().plan.steps == ()


def test_the_schema_is_published_as_text():
    jsonschema.Draft202012Validator.check_schema(joint_plan_schema())
    assert joint_plan_schema_text().startswith("{")
    with pytest.raises(jsonschema.ValidationError):
        JSON_SCHEMA.validate(task_plan('(go "attic")').as_json())


def summary(step: TaskStep) -> tuple[object, ...]:
    """A step without ids and numbers of results."""
    kinds = tuple(value.as_json()["kind"] for _, value in step.arguments)
    texts = tuple(value.as_json().get("text", "") for _, value in step.arguments)
    return (step.action, kinds, texts)


def acts_of(plan: TaskPlan) -> list[TaskStep]:
    kinds = (EffectKind.MOVES, EffectKind.FINDS)
    return [step for step in plan.steps if not has(step, *kinds)]


def found_in(plan: TaskPlan, *kinds: EffectKind) -> list[str]:
    steps = (step for step in plan.steps if has(step, *kinds))
    return [str(step.arguments[0][1].as_json().get("text", "")) for step in steps]


def is_subsequence(part: Sequence[object], whole: Sequence[object]) -> bool:
    rest = iter(whole)
    return all(each in rest for each in part)


several = st.lists(commands(most=3), min_size=1, max_size=3)


@given(several)
def test_the_order_inside_each_command_is_kept_and_nothing_is_lost(forms):
    plans = [task_plan(form) for form in forms]
    joint = joined(*forms)
    for number, plan in enumerate(plans, start=1):
        own = TaskPlan(
            tuple(
                step
                for step, commands in zip(joint.plan.steps, joint.serves, strict=True)
                if number in commands
            )
        )
        before, after = ([summary(step) for step in acts_of(each)] for each in (plan, own))
        extra = Counter(after) - Counter(before)
        # Who goes to a place is there as well if another command follows somebody to it.
        assert all(action in ("follow", "guide") for action, *_ in extra)
        assert is_subsequence(before, after)
        # Who was found or followed for another command is found, maybe earlier.
        finding = found_in(plan, EffectKind.FINDS)
        found = found_in(own, EffectKind.FINDS, EffectKind.ACCOMPANIES)
        assert not Counter(finding) - Counter(found)
        alone = zip(joint.plan.steps, joint.serves, strict=True)
        for_it = TaskPlan(tuple(step for step, commands in alone if commands == (number,)))
        assert is_subsequence(found_in(for_it, EffectKind.FINDS), finding)
    assert Counter(codes(joint.plan)) >= Counter(code for each in plans for code in codes(each))


@given(several)
def test_a_joint_plan_holds_one_thing_and_requires_earlier_steps(forms):
    joint = joined(*forms)
    JSON_SCHEMA.validate(joint.as_json())
    xml_schema().validate(to_behavior_tree(joint.plan))
    reported = {(each.code, each.step) for each in joint.plan.problems}
    held = None
    for number, step in enumerate(joint.plan.steps, start=1):
        assert step.number == number and all(0 < each < number for each in step.requires)
        if has(step, EffectKind.TAKES):
            assert held is None or (RecipeTrouble.HANDS_FULL, number) in reported
        held = step.holds


@given(several)
def test_a_joint_plan_is_never_longer_than_one_command_after_the_other(forms):
    joint = joined(*forms)
    assert joint.length == walk(joint.plan.steps, Distances())
    if not any(each.reason is Reason.HANDS for each in joint.interleavings):
        assert joint.length <= joint.length_before


@given(several)
def test_one_command_alone_stays_as_it_is(forms):
    plan = task_plan(forms[0])
    joint = join([plan], WITHOUT_WAY_BACK)
    assert calls(joint.plan) == calls(plan) == calls(joined(forms[0]).plan)[: len(plan.steps)]
    assert [each.requires for each in joint.plan.steps] == [each.requires for each in plan.steps]
    assert joint.plan.problems == plan.problems and not joint.interleavings


def shortest(plans: list[TaskPlan], distances: Distances) -> float | None:
    """The shortest walk of all orders of single steps; None if every order takes something with a full gripper.

    Between any two steps the robot may go elsewhere and come back, unless somebody or something would have to
    be found again.
    """
    goal = tuple(len(plan.steps) for plan in plans)

    places = [places_after(plan.steps, number) for number, plan in enumerate(plans, start=1)]

    def is_bound(command: int, count: int) -> bool:
        steps = plans[command].steps
        if not count or count == len(steps) or has(steps[count], EffectKind.MOVES):
            return False
        found = {
            each.number
            for each in steps[:count]
            if has(each, EffectKind.FINDS, EffectKind.ACCOMPANIES)
        }
        waiting = (each for each in steps[count:] if not has(each, EffectKind.MOVES))
        return steps[count - 1].place is None or any(found & set(each.requires) for each in waiting)

    @cache
    def rest(done: tuple[int, ...], last: int) -> float:
        here = places[last][done[last]] if last >= 0 else OPERATOR
        if done == goal:
            return distances.between(here, OPERATOR)
        best = float("inf")
        for command, plan in enumerate(plans):
            if done[command] == goal[command]:
                continue
            step = plan.steps[done[command]]
            others = [each for each in range(len(plans)) if each != command]
            holds = any(plans[each].steps[done[each] - 1].holds for each in others if done[each])
            if holds and has(step, EffectKind.TAKES, EffectKind.ACTS):
                continue
            after = places[command][done[command] + 1]
            before = after if has(step, EffectKind.MOVES) else places[command][done[command]]
            length = distances.between(here, before) + distances.between(before, after)
            is_away = here not in (before, after) or before != after
            if is_away and any(is_bound(each, done[each]) for each in others):
                continue
            following = (*done[:command], done[command] + 1, *done[command + 1 :])
            best = min(best, length + rest(following, command))
        return best

    length = rest(tuple(0 for _ in goal), -1)
    return None if length == float("inf") else length


@settings(deadline=None)
@given(st.lists(commands(most=2), min_size=2, max_size=3))
def test_no_order_of_single_steps_is_shorter(forms):
    plans = [task_plan(form) for form in forms]
    wanted = shortest(plans, Distances())
    joint = joined(*forms)
    if wanted is not None:
        assert joint.length == wanted
        own = sum(codes(plan).count(RecipeTrouble.HANDS_FULL) for plan in plans)
        assert codes(joint.plan).count(RecipeTrouble.HANDS_FULL) == own


def test_three_long_commands_take_less_than_a_second():
    parts = [f"(bring {TEA} {ADA})", f'(put {KNIFE} "tea room")', f"(greet {ADA})"]
    plans = [task_plan(f"(sequence {' '.join(parts[at:] + parts[:at])})") for at in range(3)]
    assert min(len(plan.steps) for plan in plans) >= 12
    started = time.process_time()
    joint = join(plans, default_book())
    assert time.process_time() - started < 1
    assert joint.length < joint.length_before


def test_very_long_commands_are_done_one_after_the_other():
    form = f"(sequence {' '.join([COUNT.format('attic'), COUNT.format('stool')] * 10)})"
    started = time.process_time()
    joint = joined(form, form, form)
    assert time.process_time() - started < 5
    assert joint.length == joint.length_before


def test_what_is_wrong_with_one_command_is_said_of_its_steps():
    joint = joined('(go "attic")', "(go UNKNOWN)")
    (problem,) = joint.plan.problems
    assert joint.serves[problem.step - 1] == (2,)
    assert [each["commands"] for each in joint.as_json()["problems"]] == [[2]]


@given(several)
def test_the_robot_ends_where_the_commands_were_given(forms):
    joint = joined(*forms)
    assert joint.ends_at == OPERATOR
    assert places_after(joint.plan.steps)[-1] == OPERATOR
    without = join([task_plan(form) for form in forms], WITHOUT_WAY_BACK)
    assert without.ends_at is None and without.length <= joint.length


def test_the_way_back_decides_the_order():
    """Either order is as long up to the last place; the way back from there is not."""
    table = {
        ("operator", "attic"): 5.0,
        ("operator", "tea room"): 6.0,
        ("attic", "tea room"): 9.0,
        ("operator", "stool"): 1.0,
        ("attic", "stool"): 6.0,
        ("tea room", "stool"): 2.0,
    }
    forms = [f'(go "{each}")' for each in ("stool", "attic", "tea room")]
    joint = joined(*forms, distances=Distances(table))
    assert joint.length == 17  # attic, tea room, stool; or back
    assert joint.length_before == 22
    assert calls(joint.plan)[-1] == "go_to(operator)"


def test_a_book_names_another_place_to_end_at():
    rows = [str(each) for each in WITHOUT_WAY_BACK.recipes]
    rows.append('after_commands() -> go_to("the instruction point") say("I am done")')
    book, problems = read_book(PRIMITIVES, "\n".join(rows))
    assert not [each for each in problems if each.is_error]
    distances = Distances({("instruction point", "attic"): 4.0, ("operator", "attic"): 3.0})
    joint = join([task_plan('(go "attic")'), task_plan(COUNT.format("attic"))], book, distances)
    assert calls(joint.plan)[-2:] == ["go_to(instruction point)", "say(I am done)"]
    assert joint.as_json()["ends_at"]["text"] == "the instruction point"
    JSON_SCHEMA.validate(joint.as_json())
    # The count is told to the operator, and the instruction point is nowhere near in the table.
    assert joint.length == 3 + 3 + 4


@pytest.mark.parametrize("missed", [0, 1, 2])
def test_two_of_three_are_done_where_one_is_not_understood(missed):
    forms, said = ['(go "attic")', COUNT.format("attic"), f"(greet {ADA})"], ["ab", "cd", "ef"]
    forms[missed] = "UNKNOWN"
    plans = [task_plan(form) for form in forms]
    joint = join(plans, default_book(), utterances=said)
    assert "ask_operator" not in " ".join(calls(joint.plan))
    assert not joint.plan.is_executable  # nothing begins by accident
    (waiting,) = joint.as_json()["unresolved"]
    assert (waiting["commands"], waiting["steps"]) == ([missed + 1], [])
    (gap,) = waiting["open"]
    assert gap["argument"] == "command" and said[missed] in gap["question"]
    assert {number for each in joint.serves for number in each} == {1, 2, 3} - {missed + 1}
    note = joint.notes[0]
    assert (note.code, note.commands) == (NoteKind.NOT_UNDERSTOOD, (missed + 1,))
    assert f"“{said[missed]}”" in note.message and joint.spoken.startswith(note.message)
    assert ("first", "second", "third")[missed] in note.message
    JSON_SCHEMA.validate(joint.as_json())


def test_where_none_is_understood_each_is_asked_about():
    plans = [task_plan("UNKNOWN"), task_plan(TEA), task_plan("UNKNOWN")]
    joint = join(plans, default_book(), utterances=["ab", "cd", "ef"])
    assert not joint.plan.is_executable and joint.length == 0
    questions = [step.arguments[0][1].as_json()["text"] for step in joint.plan.steps]
    for question, (ordinal, said) in zip(
        questions, (("first", "ab"), ("second", "cd"), ("third", "ef")), strict=True
    ):
        assert ordinal in question and f"“{said}”" in question


def test_a_part_that_is_not_understood_says_of_which_command_it_is():
    plans = [task_plan('(go "attic")'), task_plan('(sequence (go "stool") UNKNOWN)')]
    joint = join(plans, default_book(), utterances=["ab", "cd"])
    (asked,) = (each for each in joint.plan.steps if each.action == "ask_operator")
    question = asked.arguments[0][1].as_json()["text"]
    assert "second" in question and "“cd”" in question
    assert not joint.plan.is_executable
    alone = join(plans[1:], default_book()).plan
    assert "I did not understand that. What shall I do?" in spoken(alone)


def test_commands_that_bring_no_points_for_interleaving_are_named():
    apart = joined('(go "attic")', '(go "stool")')
    assert not apart.is_interleaved and apart.as_json()["interleaved"] == []
    assert notes_of(apart, NoteKind.NOT_INTERLEAVED) == [(1, 2)]
    one_apart = joined(COUNT.format("attic"), f"(bring {TEA})", '(go "tea room")')
    assert one_apart.interleaved == ((1, 2),)
    assert notes_of(one_apart, NoteKind.NOT_INTERLEAVED) == [(3,)]
    together = joined(COUNT.format("attic"), COUNT.format("stool"))
    assert together.interleaved == ((1, 2),)
    assert not notes_of(together, NoteKind.NOT_INTERLEAVED)
    asked_first = joined('(go "attic")', "(go UNKNOWN)")
    assert not asked_first.is_interleaved
    assert not notes_of(joined('(go "attic")'), NoteKind.NOT_INTERLEAVED)


@given(several)
def test_commands_in_turn_are_not_interleaved(forms):
    joint = joined(*forms)
    own = [
        commands
        for step, commands in zip(joint.plan.steps, joint.serves, strict=True)
        if step.source and step.action != "ask_operator"
    ]
    served = [number for each in own for number in each]
    is_in_turn = all(len(each) == 1 for each in own) and len([*groupby(served)]) == len({*served})
    assert joint.is_interleaved is not is_in_turn


def test_the_walk_has_a_unit():
    near = {("operator", "attic"): 1.25, ("operator", "tea room"): 1.0}
    forms = COUNT.format("attic"), COUNT.format("tea room")
    assert joined(*forms).unit == "rooms"
    assert joined(*forms, distances=Distances(near)).unit == "m"
    in_feet = Distances.of_rows([("operator", "attic", 3.0)], unit="ft")
    assert joined(*forms, distances=in_feet).as_json()["unit"] == "ft"
    assert [say_length(each, "rooms") for each in (1, 0, 2.5)] == ["1 room", "0 rooms", "2.5 rooms"]
    assert say_length(1234567.25, "m") == "1234567.2 m"


def test_the_robot_changes_between_commands_as_little_as_it_can():
    """What the first command keeps is taken last; all else of it is as well done right before."""
    forms = f"(sequence (bring {TEA}) (take {KNIFE}))", f"(bring {KNIFE})"
    joint = joined(*forms)
    in_turn = [commands for commands, _ in groupby(joint.serves[:-1])]
    assert in_turn == [(2,), (1,)]


NO_WAYS = Distances({("attic", "stool"): 0.0})


def test_of_equally_long_walks_the_one_of_fewer_moves_is_taken():
    joint = joined('(sequence (go "attic") (go "stool"))', '(go "attic")', distances=NO_WAYS)
    assert calls(joint.plan) == ["go_to(attic)", "go_to(stool)", "go_to(operator)"]


def test_the_way_back_is_a_move_too():
    joint = joined(COUNT.format("attic"), '(go "tea room")', distances=NO_WAYS)
    assert calls(joint.plan).count("go_to(operator)") == 1


def test_a_question_is_worth_a_change_between_commands():
    joint = joined('(say "a joke")', "(go UNKNOWN)")
    assert joint.serves[0] == (2,)


def test_the_earlier_of_two_equal_commands_is_not_overtaken():
    joint = joined('(go "tea room")', '(say "a joke")', f'(put {TEA} "tea room")')
    assert joint.serves[0] == (2,)


def test_of_equal_orders_the_earlier_command_comes_first():
    joint = joined(f"(take {TEA})", f"(bring {KNIFE})", f"(bring {TEA})")
    assert [each for each, _ in groupby(joint.serves[:-1])] == [(2,), (3,), (1,)]
