"""Typing an utterance, and seeing what the parser makes of it."""

from __future__ import annotations

import math
import os
import re
import subprocess
from dataclasses import replace
from html import unescape

import pytest
from django.template.loader import render_to_string
from django.test import Client

from annotations.background.progress import UNWATCHED
from annotations.language.forms import read_form
from annotations.language.plans import make_plan
from annotations.models import ApiToken, Command, LogicalForm, Proposal, Utterance, WorkItem
from parser_service.labelling.label_candidates import PERSON, candidates_for
from parser_service.labelling.parser_proposals import propose
from parser_service.parsers.knn import NearestNeighbour
from parser_service.parsers.registry import ORACLE
from parser_service.runs.promoting import promote
from parser_service.serving.parser_client import AWAY
from parser_service.templatetags.provenance import cut_in_words
from parser_service.templatetags.steps import referents
from parser_service.web.serving.heard_pieces import heard_pieces
from parser_service.web.serving.playground_pages import offered_candidates
from tests.annotations.conftest import import_tiny
from tests.annotations.language.sample_ontology import HOME
from tests.parser_service.live_server import parse_server  # noqa: F401
from tests.parser_service.served import make_home, name_umbrella, trained_run

PAGE = "/w/home/parse/"
FETCH = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'


@pytest.fixture
def run(world):
    return trained_run(make_home(world), train_sources="gen")


@pytest.fixture
def answering(run, parse_server):  # noqa: F811
    """A run that the parse server answers with."""
    promote(run, None)
    parse_server.update()
    return run


def asked(client, text: str, **more: object) -> str:
    answer = client.post(f"{PAGE}ask/", {"text": text, **more})
    assert answer.status_code == 200
    return answer.content.decode()


def test_spans_candidates_english_and_plan_are_shown(answering, anna):
    page = asked(anna, "Bring me the red cup")
    assert '<span class="value">red cup</span>object' in page
    assert cut_in_words("knn") not in page
    assert "bring me the red cup" in page and "<meter" in page
    assert 'class="plan-' in page and "data-tree" in page
    assert f"run {answering.pk}" in page


@pytest.mark.parametrize(
    ("page", "field", "text"),
    [
        ("parse/", "text", 'bring me Bo\'s "red" cup'),
        ("parse/", "text", "$(reboot) `id` \\ !! bring me the Süßigkeiten; exit"),
        ("parse/together/", "command1", "bring me Bo's cup"),
    ],
)
def test_the_copied_request_gives_the_same_answer(answering, anna, annotator, page, field, text):
    shown = anna.post(f"/w/home/{page}ask/", {field: text})
    curl = re.search(
        r'<textarea id="copied-curl"[^>]*>(.*?)</textarea>', shown.content.decode(), re.S
    )
    assert curl
    _, key = ApiToken.issue(annotator, "robot", scope="read")
    # A shell with a curl of its own, which prints what it is given.
    script = f'curl() {{ printf "%s\\0" "$@"; }}\n{unescape(curl[1])}'
    given = subprocess.run(
        ["sh", "-c", script], env={**os.environ, "TOKEN": key}, capture_output=True, check=True
    )
    *options, address = given.stdout.decode().rstrip("\0").split("\0")
    assert options[::2] == ["-H", "-H", "-d"]
    headers = dict(each.split(": ", 1) for each in options[1:4:2])
    answer = Client().post(
        address.removeprefix("http://testserver"),
        options[5],
        content_type=headers["Content-Type"],
        headers={"Authorization": headers["Authorization"]},
    )
    assert answer.status_code == 200
    assert answer.json() == shown.context["answer"]


def test_commands_of_the_world_are_offered_before_the_texts_of_the_paper(run, anna):
    form = LogicalForm.objects.create(
        world=run.world, text="( go )", head_predicate="go", depth=1, length=3
    )
    Command.objects.create(
        world=run.world, logical_form=form, anonymized_text="go for <object>", length=3, position=0
    )
    assert [legend for legend, _ in anna.get(PAGE).context["examples"]] == [
        "Commands of this world"
    ]
    name_umbrella(run.world)
    page = anna.get(PAGE).content.decode()
    groups = anna.get(PAGE).context["examples"]
    assert [legend for legend, _ in groups] == ["Commands of this world", "Texts of the paper"]
    (_, own), (_, paper) = groups
    assert own and [number for _, texts in groups for number, _ in texts] == list(
        range(1, len(own) + len(paper) + 1)
    )
    for _, text in own:
        assert "<" not in text and f'value="{text}"' in page


def test_what_a_reference_in_a_plan_stands_for_is_said():
    text = '(sequence (find (λ$1:e (is_a $1 "tea") (at $1 "stool"))) (bring it (λ$1:e (person $1) (at $1 "stool"))))'
    found, brought = make_plan(read_form(text), HOME).as_json()["steps"]
    assert referents(found) == []
    assert referents(brought) == [("it", "the tea that is at the stool")]


def test_that_the_parser_read_only_the_beginning_is_said(
    run,
    anna,
    monkeypatch,
    parse_server,  # noqa: F811
):
    read = NearestNeighbour.predict
    monkeypatch.setattr(
        NearestNeighbour,
        "predict",
        lambda *asked: [[replace(each, is_cut=True) for each in one] for one in read(*asked)],
    )
    promote(run, None)
    parse_server.update()
    page = asked(anna, "bring me the red cup")
    assert page.count(cut_in_words("knn")) == 2  # in the mark's title, and beside it


def test_what_is_open_is_asked(answering, anna):
    page = asked(anna, "bring me the bowl the red cup")
    assert "Bowl or red cup?" in page and 'class="playground-question"' in page


def test_the_address_follows(answering, anna):
    answer = anna.post(f"{PAGE}ask/", {"text": "  find  it\0", "run": answering.pk})
    assert answer["HX-Replace-Url"] == f"{PAGE}?text=find+it&run={answering.pk}"
    page = anna.get(PAGE, {"text": "find <it>", "run": answering.pk})
    assert 'value="find &lt;it&gt;"' in page.content.decode()


def test_while_nobody_answers_the_page_says_so_and_asks_again(run, anna):
    page = asked(anna, "bring me the bowl")
    assert AWAY in page and "every 3s" in page
    assert AWAY in anna.get(f"{PAGE}state/").content.decode()
    assert anna.get(PAGE).status_code == 200


def test_what_cannot_be_answered_is_said(run, anna, parse_server):  # noqa: F811
    parse_server.update()
    answer = anna.post(f"{PAGE}ask/", {"text": "bring me the bowl"})
    assert "home" in answer.context["refused"]
    assert 'role="alert"' in answer.content.decode() and "every 3s" not in answer.content.decode()
    assert "<article" not in asked(anna, " ") and 'role="alert"' not in asked(anna, " ")


def test_the_state_says_which_run_answers(answering, anna):
    state = anna.get(f"{PAGE}state/")
    assert state.context["held"]["run"] == answering.pk
    assert f'<a href="/w/home/runs/{answering.pk}/"' in state.content.decode()


def test_a_world_without_templates_and_runs_says_so(world, anna, rene):
    assert "/w/home/templates/new/" in anna.get(PAGE).content.decode()
    page = rene.get(PAGE).content.decode()
    assert '<div class="empty">' in page and "/templates/new/" not in page


def parts_offered(page: str) -> list[str]:
    """The values of the select that says what answers."""
    return re.findall(r'<option value="([^"]*)"', page)


def test_a_world_with_templates_answers_without_a_run(world, anna, parse_server):  # noqa: F811
    import_tiny(world)
    parse_server.update()
    parse_server.find("home", None, patience=1)  # threads do not see what a test has written
    assert parts_offered(anna.get(PAGE).content.decode()) == ["", ORACLE]
    answer = anna.post(f"{PAGE}ask/", {"text": "locate the tea"}).context["answer"]
    assert (answer["parser"], answer["run"]) == (ORACLE, None)


def test_each_part_is_asked_alone(answering, anna):
    assert parts_offered(anna.get(PAGE).content.decode()) == ["", str(answering.pk)]
    answer = anna.post(f"{PAGE}ask/", {"text": "find the bowl", "run": ORACLE})
    assert "home" in answer.context["refused"]  # it has no templates
    assert answer["HX-Replace-Url"].endswith(f"&run={ORACLE}")


@pytest.mark.parametrize(
    ("decision", "probability", "sureness"),
    [
        ("act", 0.99, "sure"),
        ("confirm", 0.77, "77 %: shall I?"),
        ("ask", 0.9, "90 %: one question"),
        ("refuse", 0.03, "unsure: 3 %"),
        ("refuse", None, "not understood"),
    ],
)
def test_how_sure_an_answer_is_stands_in_words_with_one_figure(decision, probability, sureness):
    answer = {"decision": decision, "probability": probability, "sureness": sureness}
    shown = render_to_string("parser_service/_sureness.html", {"answer": answer})
    assert f'data-decision="{decision}"' in shown
    assert sureness in shown.replace(sureness.capitalize(), sureness)
    assert shown.count("%") == (probability is not None)


def test_an_answer_whose_plan_no_robot_can_carry_out_is_not_shown_as_one_to_act_on():
    answer = {"decision": "act", "probability": 0.99, "sureness": "sure"}
    tones = []
    for is_executable in (True, False):
        answer["candidates"] = [{"task_plan": {"is_executable": is_executable}}]
        shown = render_to_string("parser_service/_sureness.html", {"answer": answer})
        tones += re.findall('data-decision="(.*?)"', shown)
    assert tones == ["act", "ask"]


def test_the_plan_of_an_answer_stands_beside_how_sure_it_is(answering, anna):
    page = asked(anna, "bring me the red cup")
    assert (
        page.index('class="sureness"')
        < page.index('class="plan-spoken"')
        < page.index("plan-steps")
    )
    assert page.count('class="plan-steps"') == page.count('class="sureness"')


HEARD = {
    "utterance": "uh bring the apple to Haley",
    "heard": [
        {"kind": "filler", "start": 0, "end": 2, "said": "uh", "heard": ""},
        {"kind": "sound", "start": 22, "end": 27, "said": "Haley", "heard": "Hailey"},
    ],
    "spans": [
        {"start": 13, "end": 18, "entity_class": "object", "value": "apple"},
        {"start": 22, "end": 27, "entity_class": "name", "value": "Hailey"},
    ],
}


def test_what_was_heard_otherwise_is_marked_where_it_was_said():
    pieces = heard_pieces(HEARD)
    assert "".join(piece.text for piece in pieces) == HEARD["utterance"]
    assert [(piece.text, piece.heard) for piece in pieces if piece.why] == [
        ("uh", ""),
        ("Haley", "Hailey"),
    ]
    assert [piece.value for piece in pieces if piece.entity_class] == ["apple"]
    put_in = {"kind": "article", "start": 3, "end": 3, "said": "", "heard": "the"}
    (inserted,) = [
        piece
        for piece in heard_pieces({"utterance": "go home", "heard": [put_in], "spans": []})
        if piece.why
    ]
    assert (inserted.text, inserted.heard) == ("", "the")


def wrong(client, **sent: object):
    return client.post(f"{PAGE}wrong/", {"text": "get the mug", "answered": "( x )", **sent})


def test_a_wrong_answer_goes_to_the_work_queue_with_the_right_form(run, anna):
    page = wrong(anna, run=run.pk, right_form=FETCH, reason="it is not a search")
    assert page.context["sent"] in page.content.decode()
    item = WorkItem.objects.get()
    assert (item.utterance.text, item.kind) == ("get the mug", "requested")
    assert item.reason.startswith("anna ") and item.reason.endswith(" it is not a search")
    assert f" Nearest neighbour (run {run.pk}) " in item.reason
    wrong(anna, text="find the mug", parser=ORACLE)
    assert " Grammar oracle " in WorkItem.objects.latest("pk").reason
    first = candidates_for(item.utterance)[0]
    assert first.form == FETCH and first.sources[0] == PERSON


def test_parsers_do_not_replace_what_a_person_gave(run, anna, world):
    wrong(anna, right_form=FETCH)
    job = world.jobs.get(kind="propose")
    propose(job, UNWATCHED)
    assert set(Proposal.objects.values_list("source", flat=True)) == {PERSON, "knn"}


def test_the_answer_itself_is_not_taken_for_the_right_form(run, anna):
    assert wrong(anna, right_form=" ( x )\n").context["sent"]
    assert not Proposal.objects.exists()


def test_it_may_be_that_no_form_is_right(run, anna):
    wrong(anna, right_form="UNKNOWN")
    assert "UNKNOWN" in WorkItem.objects.get().reason


def test_a_labelled_utterance_becomes_a_label_in_doubt(run, rene, world):
    Utterance.objects.create(
        world=world,
        text="get the mug",
        anonymized_text="get the mug",
        status="labelled",
        logical_form='( go " <room> " )',
    )
    assert wrong(rene, right_form=FETCH).context["sent"]
    assert world.audit_findings.get().suggested_form == FETCH


def test_a_form_that_is_none_is_refused_and_kept(run, anna):
    answer = wrong(anna, right_form='( bring "<x>', reason="so")
    page = answer.content.decode()
    assert answer.status_code == 422 and 'role="alert"' in page
    assert "( bring &quot;&lt;x&gt;</textarea>" in page and 'value="so"' in page
    assert not WorkItem.objects.exists() and not Utterance.objects.exists()


def scored(*shares: float, is_well_formed: bool = True) -> list[dict[str, object]]:
    return [
        {"form": FETCH, "score": math.log(share), "is_well_formed": is_well_formed}
        for share in shares
    ]


def test_what_is_no_form_and_what_has_no_share_to_speak_of_is_not_offered():
    candidates = [*scored(0.4, 0.0004), *scored(0.3, is_well_formed=False), *scored(0.0006)]
    shown = offered_candidates({"candidates": candidates, "score_kind": "log_probability"})
    assert [share for _, share in shown.offered] == pytest.approx([0.4, 0.0006])
    assert [each for each, _ in shown.left_out] == [candidates[1], candidates[2]]
    assert len({reason for _, reason in shown.left_out}) == 2


def test_the_best_form_is_offered_whatever_its_share():
    answer = {"candidates": scored(0.0001, 0.0001), "score_kind": "log_probability"}
    assert len(offered_candidates(answer).offered) == 1
