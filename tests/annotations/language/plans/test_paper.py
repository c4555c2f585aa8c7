from __future__ import annotations

from annotations.language.forms import canonical_text, read_form, to_template
from annotations.language.grounding import Anonymizer
from annotations.language.plans import DialogueManager, Offer, Phase
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.annotations.language.plans.robot import BRING, PUT
from tests.annotations.language.published import SHARED, needs_corpus


@needs_corpus
def test_the_examples_of_the_paper() -> None:
    """Walker et al. 2019, §3.1 to §3.3, in the house of 2018."""
    ontology, _ = read_ontology_folder(SHARED / "generator-2018")
    robot = DialogueManager(ontology, {})
    anonymizer = Anonymizer(ontology)
    heard = anonymizer.anonymize("Fetch an apple from the kitchen")
    assert heard.text == "Fetch an <object> from the <room>"  # rooms have a token of their own

    named = "Navigate to the kitchen, look for the apple, and give it to Bill"
    bring = (
        '(bring (λ$1:e (is_a $1 "<object>") (at $1 "<room>")) '
        '(λ$1:e (person $1) (name $1 "<name>")))'
    )
    state = robot.begin(read_form(bring), anonymizer.anonymize(named))
    assert state.asked is not None and state.asked.phrases == ("Bill",)  # 2018 knows no Bill
    state = robot.reply(state, "Bill")
    assert state.offers == (Offer("name", "Bill"),)
    done = robot.reply(state, "yes")
    assert canonical_text(done.form) == canonical_text(
        read_form(
            '(bring (λ$1:e (is_a $1 "apple") (at $1 "kitchen")) (λ$1:e (person $1) (name $1 "Bill")))'
        )
    )

    moved = "Move the apple from the counter to the dining table"
    state = robot.begin(read_form(PUT), anonymizer.anonymize(moved))
    assert state.phase is Phase.CONFIRMING
    assert to_template(state.form) == (
        '(put (λ$1:e (is_a $1 "apple") (at $1 "counter")) "dining table")'
    )

    umbrella = robot.begin(read_form(BRING), anonymizer.anonymize("Bring an umbrella to me"))
    assert umbrella.prompt.startswith("Which object do you mean by “umbrella”?")
