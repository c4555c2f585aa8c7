"""The world ``competition`` is whole and without a fault, and reads every kind of command of 2025 and 2026."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from random import Random

import pytest

from annotations.exchange.predicates_file import read_predicates
from annotations.exchange.shipped_worlds import SHIPPED_WORLDS
from annotations.generation.grounded_pairs import GroundedCommands
from annotations.language.forms import Constant, canonical_text, read_form, walk
from annotations.language.grammar import read_production
from annotations.language.plans import (
    apply_recipes,
    default_book,
    make_plan,
    same_plan,
    shipped_books,
    spoken,
    usual_places,
)
from annotations.language.templates import (
    DEFAULT_LIMIT,
    Balance,
    Generated,
    GeneratorFolder,
    Language,
    SampleRequest,
    TaskCategory,
    TemplateExpander,
    read_generator_files,
    read_template,
    set_problems,
)
from annotations.language.templates.grammar_expansions import too_many_commands
from annotations.language.texts.decoding import read_folder
from annotations.language.world import (
    COMPETITION_FILES,
    Ontology,
    Predicate,
    check_form,
    gloss,
    infer_signatures,
    read_competition,
)
from parser_service.parsers.interface import Knowledge
from parser_service.parsers.oracle import GrammarOracle
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.annotations.language.published import SHARED

FOLDER = SHIPPED_WORLDS["competition"].folder
COMPETITION = SHARED / "competition-2025"
# Commands that leave something out, with the heads and the constants of their forms.
PLAIN = Path(__file__).parent / "plain_commands.txt"
PLACES = ("location", "room")
NAMED = ("object", "category", "name", "location", "room")
# Kind → a command with entities of this world, and the heads of the actions that it asks for.
KINDS = {
    "goToLoc": ("head over to the workbench", "go"),
    "takeObjFromPlcmt": ("collect the ladle from the draining board", "take"),
    "takeObj": ("find a papaya in the galley, then grab it and bring it to me", "find take bring"),
    "findPrsInRoom": ("search for someone waving in the lobby and tell them the time", "find say"),
    "findObjInRoom": ("in the galley, locate the papaya", "find"),
    "findObj": ("drive to the larder and spot a fruit and bring it here", "go find bring"),
    "findPrs": ("go to the lobby then find the sitting person and follow her", "go find follow"),
    "meetPrsAtBeac": ("meet up with Otto at the piano", "meet"),
    "meetName": ("go to the lobby, and then meet Otto and tell him the time", "go meet say"),
    "meetNameAtLocThenFindInRm": (
        "first meet Bea at the piano and then find her again in the lobby",
        "meet find",
    ),
    "countObjOnPlcmt": ("how many drinks are there on the bar counter", "say"),
    "countPrsInRoom": ("count the people pointing left in the lobby", "say"),
    "countClothPrsInRoom": ("how many people in the lobby are wearing red coats", "say"),
    "tellPrsInfoInLoc": ("tell me who is at the window seat", "say"),
    "tellObjPropOnPlcmt": ("on the workbench, which is the heaviest item", "say"),
    "tellCatPropOnPlcmt": ("let me know which snack on the piano is the lightest", "say"),
    "tellPrsInfoAtLocToPrsAtLoc": (
        "tell the pose of the person at the piano to the person at the workbench",
        "say",
    ),
    "talkInfoToGestPrsInRoom": ("let the waving person in the galley know the time", "say"),
    "talkInfo": ("greet Lene in the lobby and tell her your team's name", "greet say"),
    "answerToGestPrsInRoom": ("answer the quiz of someone waving in the lobby", "answer"),
    "answerQuestion": ("meet Ivo in the lobby and answer his question", "meet answer"),
    "followNameFromBeacToRoom": ("walk behind Ivo from the piano to the galley", "follow"),
    "followPrsAtLoc": ("follow whoever is standing at the piano", "follow"),
    "followPrs": ("find Ivo in the lobby and go after him", "find follow"),
    "followPrsToRoom": ("find Ivo in the lobby and follow him as far as the larder", "find follow"),
    "guideNameFromBeacToBeac": ("accompany Maria from the piano to the front door", "guide"),
    "guidePrsFromBeacToBeac": ("take the waving person from the piano to the lobby", "guide"),
    "guideClothPrsFromBeacToBeac": (
        "lead the person in a grey jumper from the piano to the lobby",
        "guide",
    ),
    "guidePrsToBeacon": ("meet Maria in the lobby then walk her to the piano", "meet guide"),
    "bringMeObjFromPlcmt": ("from the larder, bring me the oatmeal", "bring"),
    "deliverObjToMe": ("get the yo-yo from the piano and give it to me", "take bring"),
    "deliverObjToPrsInRoom": (
        "get the yo-yo from the piano and carry it to the lying person in the lobby",
        "take bring",
    ),
    "deliverObjToNameAtBeac": (
        "get the yo-yo from the piano and pass it to Hugo at the workbench",
        "take bring",
    ),
    "placeObjOnPlcmt": ("get the yo-yo from the piano and leave it on the map table", "take put"),
    "putObjInTrash": ("get the yo-yo from the piano and throw it in the trash", "take put"),
    "greetClothDscInRm": ("say hi to the person in a red coat in the lobby", "greet"),
    "greetNameInRm": ("in the lobby, welcome Tariq", "greet"),
}


@cache
def ontology() -> Ontology:
    return read_ontology_folder(FOLDER)[0]


@cache
def folder() -> GeneratorFolder:
    return read_generator_files(read_folder(FOLDER, "*.txt"), ontology().classes)


@cache
def categories() -> tuple[TaskCategory, ...]:
    return folder().categories()


@cache
def predicates() -> dict[str, Predicate]:
    return read_predicates((FOLDER / "predicates.json").read_bytes(), classes=ontology().classes)


@cache
def sample() -> Generated:
    request = SampleRequest(2_000, balance=Balance.FORMS)
    return Language(categories()).sample(request).generated


@cache
def oracle() -> GrammarOracle:
    return GrammarOracle(knowledge=Knowledge(ontology=ontology(), grammar=categories()))


def heads(form: str) -> list[str]:
    """The heads of the actions of a form, in order."""
    read = read_form(form)
    actions = read.arguments if read.predicate == "sequence" else (read,)
    return [str(each.predicate) for each in actions]


def constants(form: str) -> list[str]:
    """The texts of a form, in order."""
    return [str(each.value) for each in walk(read_form(form)) if isinstance(each, Constant)]


def grounded(parser: GrammarOracle, utterance: str) -> set[str]:
    """The best forms of an utterance, with its entities."""
    candidates = parser.predict([utterance], 5)[0]
    best = [each for each in candidates if each.score == candidates[0].score]
    forms = set()
    for each in best:
        values = iter(each.values)
        forms.add(re.sub(r'" <\w+> "', lambda _: f'" {next(values)} "', each.form))  # noqa: B023
    return forms


def test_the_files_read_without_a_problem():
    assert folder().problems == ()
    assert read_ontology_folder(FOLDER)[1] == ()
    assert [each.name for each in categories()] == ["2025", "2026"]


def test_no_template_has_a_problem_but_that_it_makes_too_many_commands_to_store():
    too_large = set()
    for category in categories():
        expander = TemplateExpander(category.grammar, category.lines)
        for each in category.templates:
            too_large.add(too_many_commands(each, expander.size(each), DEFAULT_LIMIT))
    assert set(set_problems(categories(), sample(), predicates())) <= too_large


def test_commands_of_a_sample_have_one_form_each_and_are_in_the_grammar():
    assert sample().conflicts == ()
    assert sample().outside_grammar == ()
    assert {each.task_category for each in sample().expansions} == {"2025", "2026"}


def test_what_is_generated_is_understood_with_and_without_its_entities():
    """The class tokens of stored commands are no entities, and each entity fills the slot that it was drawn for."""
    random = Random(11)
    sources = {category.name: GroundedCommands(category) for category in categories()}
    two_places = 0
    for expansion in random.sample(sample().expansions, 60):
        assert oracle().predict([expansion.command])[0][0].form == expansion.form_text
        drawn = sources[expansion.task_category].draw(expansion, ontology(), random)
        assert canonical_text(drawn.form) in grounded(oracle(), drawn.text)
        places = [each.text for slot, each in drawn.values if slot.entity_class in PLACES]
        two_places += len(set(places)) > 1
    assert two_places  # lines of one command name places of their own


def test_there_are_some_hundreds_of_forms_and_they_fit_the_predicates():
    forms = {each.form_text for each in sample().expansions}
    assert 800 < len(forms) < 1_100
    inferred = infer_signatures(map(read_form, forms))
    assert set(inferred) == set(predicates())
    for form in forms:
        assert check_form(read_form(form), predicates()) == []


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_read(kind):
    command, wanted = KINDS[kind]
    assert {" ".join(heads(form)) for form in grounded(oracle(), command)} == {wanted}


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("bring me a quince from the larder", "from the larder, please fetch me the quince"),
        ("find Otto in the lobby", "in the lobby, could you look for Otto"),
        (
            "find Otto in the lobby and follow him",
            "First find Otto in the lobby, then follow them.",
        ),
        ("what is the biggest game on the piano", "tell me what is the largest game on the piano"),
    ],
)
def test_other_wordings_have_the_same_form(one, other):
    assert grounded(oracle(), one) == grounded(oracle(), other) != set()


@pytest.mark.parametrize(
    ("said", "like"),
    [
        ("find Otto in the lobby and follow Otto", "find Otto in the lobby and follow him"),
        (
            "find Otto in the lobby and tell this person the time",
            "find Otto in the lobby and tell him the time",
        ),
        ("find Otto in the lobby and follow that one", "find Otto in the lobby and follow him"),
        (
            "meet Bea at the piano then find Bea in the lobby",
            "meet Bea at the piano then find her in the lobby",
        ),
        (
            "find a quince in the galley, take that one and bring it to me",
            "find a quince in the galley, take it and bring it to me",
        ),
        (
            "take a quince from the larder and bring the quince to Bea",
            "take a quince from the larder and bring it to Bea",
        ),
    ],
)
def test_who_or_what_is_said_again_is_referred_to(said, like):
    assert grounded(oracle(), said) == grounded(oracle(), like) != set()


@pytest.mark.parametrize(
    "said",
    [
        "find Otto in the lobby and follow Bea",
        "take a quince from the larder and bring the papaya to Bea",
        "follow Otto",
        "follow this person",
    ],
)
def test_nothing_is_referred_to_that_was_not_said(said):
    assert not any("them" in form or "it )" in form for form in grounded(oracle(), said))


@pytest.mark.parametrize(
    ("one", "other"),
    [
        # The rulebook's own example of a rephrasing, with things of this house.
        (
            "bring me a quince from the larder",
            "go to the larder, find a quince, and bring it to me",
        ),
        (
            "take the quince from the larder and put it on the workbench",
            "go to the larder, find a quince, take it and put it on the workbench",
        ),
        (
            "follow the person waving at the piano",
            "find the person waving at the piano and follow them",
        ),
        ("bring Otto the cocoa", "take the cocoa and give it to Otto"),
        ("put the ladle on the piano", "find the ladle, take it and put it on the piano"),
        ("throw the pretzel away", "get the pretzel and get rid of it"),
    ],
)
def test_other_actions_for_the_same_errand_are_the_same_plan(one, other):
    def plan(command):
        (form,) = grounded(oracle(), command)
        plan_of_form = make_plan(read_form(form), ontology(), predicates())
        return form, apply_recipes(plan_of_form, default_book(), usual_places(ontology()))

    (form, task_plan), (other_form, other_task_plan) = plan(one), plan(other)
    assert form != other_form and same_plan(task_plan, other_task_plan)


def test_questions_are_of_2025_and_the_trash_is_of_2026():
    of_2025, of_2026 = (Knowledge(ontology=ontology(), grammar=(each,)) for each in categories())
    question, trash = KINDS["answerQuestion"][0], KINDS["putObjInTrash"][0]
    for knowledge, is_read, is_not in ((of_2025, question, trash), (of_2026, trash, question)):
        parser = GrammarOracle(knowledge=knowledge)
        assert grounded(parser, is_read) and not parser.predict([is_not])[0]


def test_paraphrases_rewrite_commands_of_every_kind_of_action_with_their_forms():
    lines = (FOLDER / "paraphrases.txt").read_text("utf-8").splitlines()
    records = list(zip(lines[::3], lines[1::3], lines[2::3], strict=True))
    assert len(records) >= 200
    assert len({utterance.lower() for utterance, _, _ in records}) == len(records)
    said: set[str] = set()
    for prompt, form in {(prompt, form) for _, prompt, form in records}:
        assert grounded(oracle(), prompt) == {form}
        said |= {" ".join(heads(form))}
    assert {wanted for _, wanted in KINDS.values()} <= said


@pytest.mark.parametrize(
    ("said", "wanted"),
    [
        ("find a person in the galley and follow them", "find follow"),
        ("go to the lobby, find someone and tell them the time", "go find say"),
        ("in the lobby, greet the person", "greet"),
        ("follow the person at the piano", "follow"),
        ("guide the person from the piano to the lobby", "guide"),
        ("please tell me what day it is", "say"),
        ("could you say something about yourself", "say"),
    ],
)
def test_nobody_in_particular_is_found_and_whoever_asks_is_told(said, wanted):
    (form,) = grounded(oracle(), said)
    assert " ".join(heads(form)) == wanted
    assert make_plan(read_form(form), ontology(), predicates()).is_executable


@pytest.mark.parametrize(
    ("form", "said"),
    [
        ('(find (λ$1:e (person $1) (pose $1 "<pose>")))', "find the person who is in the pose"),
        ('(find (λ$1:e (person $1) (pose $1 "sitting")))', "find the person who is sitting"),
        ('(say "the time")', "tell me the time"),
        ('(say "<topic>")', "tell me the topic"),
    ],
)
def test_forms_with_open_places_read_well(form, said):
    assert gloss(read_form(form), predicates(), ontology().classes) == said


def test_the_trash_is_the_garbage_pail():
    (form,) = grounded(oracle(), KINDS["putObjInTrash"][0])
    plan = make_plan(read_form(form), ontology(), predicates())
    assert plan.is_executable
    assert dict(plan.steps[-1].arguments)["destination"].text == "garbage pail"


@pytest.mark.parametrize(
    ("said", "as_written"),
    [
        (
            "Go to the galley, find Bea at the larder and guide her to the piano",
            "go to the galley and find Bea at the larder and guide them to the piano",
        ),
        ("1. Bring me the cocoa.", "bring me the cocoa"),
        ("(2) follow Otto", "follow Otto"),
        ("Ｂｒｉｎｇ ｍｅ ｔｈｅ ｃｏｃｏａ．", "bring me the cocoa"),
        ("１．ﬁnd ｔｈｅ ｃｏｃｏａ", "find the cocoa"),
        (
            "Go to the ｌｏｂｂｙ，ﬁnd Otto and follow him",
            "go to the lobby, find Otto and follow him",
        ),
    ],
)
def test_commas_pronouns_numbers_of_lists_and_other_letters_are_heard(said, as_written):
    assert grounded(oracle(), said) == grounded(oracle(), as_written) != set()


def test_plain_commands_are_read_whatever_they_leave_out():
    lines = PLAIN.read_text("utf-8").splitlines()
    commands = [line.split("|") for line in lines if not line.startswith("#")]
    assert len(commands) == 60
    wrong = {}
    for said, wanted, values in commands:
        forms = grounded(oracle(), said.strip())
        found = {(" ".join(heads(form)), ", ".join(constants(form))) for form in forms}
        if found != {(wanted.strip(), values.strip())}:
            wrong[said] = found
            continue
        (form,) = forms
        assert check_form(read_form(form), predicates()) == []
        plan = make_plan(read_form(form), ontology(), predicates())
        for book in shipped_books().values():
            task_plan = apply_recipes(plan, book.book, usual_places(ontology()))
            assert spoken(task_plan).startswith("I will ")
        # Nobody has said where to, so the plan asks.
        assert plan.is_executable == (said.strip() != "guide Freya")
    assert wrong == {}


def test_the_kind_of_the_documents_is_added_by_two_rows():
    """docs/guides/writing.md, A new kind of command"""
    of_2026 = categories()[1]
    production = read_production("$with_thing = hand it to {name 1}")
    line = read_template(
        "$with_thing -> hand it to {name 1} = (hand_over it (λ$1:e (person $1) (name $1 {name 1})))"
    )
    grammar = type(of_2026.grammar)((*of_2026.grammar.productions, production))
    added = replace(of_2026, grammar=grammar, templates=(*of_2026.templates, line))
    parser = GrammarOracle(knowledge=Knowledge(ontology=ontology(), grammar=(added,)))
    command = "find a drink in the lobby, take it and hand it to Maria"
    assert [heads(form) for form in grounded(parser, command)] == [["find", "take", "hand_over"]]
    assert not oracle().predict([command])[0]


def test_the_world_is_as_large_as_its_readme_says():
    readme = (FOLDER / "README.md").read_text("utf-8")
    files = folder().grammars.files
    own = [len(file.productions) for name, file in files.items() if name.startswith("category")]
    records = len((FOLDER / "paraphrases.txt").read_text("utf-8").splitlines()) // 3
    for figure in (
        f"`words.txt` | {len(files['words.txt'].productions)} |",
        f"`kinds.txt` | {len(files['kinds.txt'].productions)} |",
        f"`category_2026_grammar.txt` | {' + '.join(map(str, own))} |",
        f"`category_*_semantics.txt` | {sum(map(len, folder().templates.values()))} |",
        f"`predicates.json` | {len(predicates())} |",
        f"`paraphrases.txt` | {records} |",
    ):
        assert figure in readme


@pytest.mark.skipif(not COMPETITION.is_dir(), reason=f"there is no {COMPETITION}")
def test_all_commands_of_a_competition_are_read_as_they_are():
    files = {name: (COMPETITION / name).read_bytes() for name in COMPETITION_FILES}
    kept = [each for each in ontology().entities if each.entity_class not in NAMED]
    theirs = replace(ontology(), entities=(*read_competition(files)[0].entities, *kept))
    parser = GrammarOracle(knowledge=Knowledge(ontology=theirs, grammar=categories()))
    plurals = theirs.singulars
    for line in (COMPETITION / "gold.jsonl").read_text("utf-8").splitlines():
        gold = json.loads(line)
        best = parser.predict([gold["command"]])[0][0]
        assert heads(best.form) == gold["heads"], gold["command"]
        classes = re.findall(r'" <(\w+)> "', best.form)
        pairs = zip(classes, best.values, strict=True)
        said = [plurals.get(value, value).casefold() for name, value in pairs if name in NAMED]
        texts = [each["text"] for each in gold["slots"] if each["class"] in NAMED]
        wanted = [plurals.get(text, text).casefold() for text in texts]
        assert said == wanted, gold["command"]
