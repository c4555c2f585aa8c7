"""The pages of the work queue, as an annotator, a third person and an admin use them."""

from __future__ import annotations

import pytest
from django.urls import reverse

from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import WantedItem, enqueue, refill, set_share
from annotations.labelling.giving import next_item
from annotations.labelling.item_answers import answer
from annotations.models import Utterance, Verdict, WorkItem, WorkKind
from annotations.models.worlds import Role
from tests.conftest import member
from tests.notices import levels
from tests.sample_world import paraphrase_in

BRING = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'
GO = '( go " <room> " )'


@pytest.fixture
def utterances(tiny_world, annotator) -> list[Utterance]:
    collect(tiny_world, ["bring me tea", "go to the kitchen"], by=annotator)
    return list(tiny_world.utterances.order_by("pk"))


@pytest.fixture
def item(tiny_world, utterances) -> WorkItem:
    refill(tiny_world)
    return tiny_world.work_items.order_by("pk").first()


@pytest.fixture
def berta(tiny_world):
    return member(tiny_world, "berta", Role.ANNOTATOR)


@pytest.fixture
def differing(tiny_world, utterances, annotator, berta) -> WorkItem:
    """An item in which a third person compares the labels of two."""
    set_share(tiny_world, WorkKind.UNLABELLED, 100)
    for person, form in ((annotator, BRING), (berta, GO)):
        part = next_item(person, tiny_world)
        answer(part.item.utterance, Verdict.FORM, form, person, 1)
    return part.item.followed_by


def act(browser, item, step, **values):
    path = reverse("queue_act", args=["home", item.pk])
    return browser.post(path, {"step": step, **values}, follow=True)


def test_the_next_item_leads_to_the_page_on_which_it_is_done(tiny_world, anna, item):
    answer = anna.post(reverse("queue_next", args=["home"]))
    assert answer["Location"] == f"/w/home/label/?utterance={item.utterance_id}"
    page = anna.get("/w/home/queue/")
    assert page.context["held"].item == item and item.reason in page.text
    assert f'class="primary" href="{answer["Location"]}"' in page.text


def test_a_reviewer_without_work_is_told(tiny_world, rene, item):
    answer = rene.post(reverse("queue_next", args=["home"]), follow=True)
    assert answer.redirect_chain[-1][0] == "/w/home/queue/"
    assert levels(answer) == ["info"]


def test_an_item_is_taken_given_back_and_skipped(anna, item, annotator):
    assert act(anna, item, "take").status_code == 200
    for step in ("give_back", "take", "skip"):
        assert "error" not in levels(act(anna, item, step))
        assert annotator.assignments.held().exists() == (step == "take")
    assert levels(act(anna, item, "skip")) == ["error"]
    assert not annotator.assignments.held().exists()


def test_whoever_is_alone_gets_back_what_they_skipped(tiny_world, anna, item, annotator):
    label, following = "/w/home/label/", reverse("queue_next", args=["home"])
    act(anna, item, "take")
    skipped = act(anna, item, "skip")
    assert 'name="step" value="take"' in skipped.text  # Undo, in the message
    anna.post(following)
    tiny_world.utterances.exclude(pk=item.utterance_id).update(status="excluded")
    for page in (label, "/w/home/queue/"):
        assert "Go through 1 that you skipped" in anna.get(page).text
    assert anna.post(following)["Location"] == "/w/home/queue/"
    again = anna.post(following, {"skipped": "yes"})
    assert again["Location"] == f"{label}?utterance={item.utterance_id}"
    assert annotator.assignments.held().get().item == item
    assert "that you skipped" not in anna.get("/w/home/queue/").text


def test_a_skip_is_undone_from_its_message(anna, item, annotator):
    act(anna, item, "take")
    act(anna, item, "skip")
    act(anna, item, "take")
    assert annotator.assignments.held().get().item == item


def test_what_one_skipped_is_not_theirs_once_somebody_else_has_done_it(
    tiny_world, anna, item, annotator, berta
):
    act(anna, item, "take")
    act(anna, item, "skip")
    answer(item.utterance, Verdict.FORM, BRING, berta, 1)
    assert "that you skipped" not in anna.get("/w/home/queue/").text
    assert levels(act(anna, item, "take")) == ["error"]


def test_an_utterance_is_done_by_labelling_and_a_template_by_saying_so(tiny_world, anna, item):
    act(anna, item, "take")
    assert levels(act(anna, item, "done")) == ["error"]
    item.refresh_from_db()
    assert item.is_open
    template = tiny_world.grammar.templates.first()
    enqueue(tiny_world, WorkKind.REQUESTED, [WantedItem(template, "Rene asks for a look.")])
    asked = tiny_world.work_items.get(template=template)
    act(anna, asked, "take")
    act(anna, asked, "done")
    asked.refresh_from_db()
    assert not asked.is_open


def test_an_admin_assigns_and_withdraws_and_nobody_else_does(adam, anna, item, berta):
    assert act(anna, item, "assign", person=berta.pk).status_code == 403
    assert levels(act(adam, item, "assign", person=berta.pk)) == ["success"]
    assert berta.assignments.held().get().item == item
    assert levels(act(adam, item, "assign", person=berta.pk)) == ["error"]
    assert levels(act(adam, item, "withdraw")) == ["success"]
    assert levels(act(adam, item, "assign", person=0)) == ["error"]
    assert not item.assignments.held().exists()


def test_an_admin_assigns_the_first_items_of_a_list(tiny_world, adam, item, berta, reviewer):
    assign = reverse("queue_assign", args=["home"])
    sent = {"person": berta.pk, "count": 5}
    for address, total in ((f"{assign}?q=kitchen", 1), (assign, 2), (assign, 2)):
        assert levels(adam.post(address, sent, follow=True)) == ["success"]
        assert berta.assignments.held().count() == total
    held = berta.assignments.held().order_by("pk")
    assert [part.item.title for part in held] == ["go to the kitchen", "bring me tea"]
    answer = adam.post(assign, {**sent, "count": 101}, follow=True)
    assert levels(answer) == ["error"] and " 100 " in str(*answer.context["messages"])


def test_the_list_is_filtered(tiny_world, adam, item, berta):
    act(adam, item, "assign", person=berta.pk)

    def rows(query):
        page = adam.get(f"/w/home/queue/?{query}")
        return [row.pk for row in page.context["listing"].rows]

    assert rows("state=taken") == rows(f"person={berta.pk}") == [item.pk]
    assert item.pk not in rows("state=free")
    assert rows("state=done") == []
    assert len(rows("kind=unlabelled")) == 2


def test_the_labels_of_others_are_not_shown_before_one_compares_them(tiny_world, anna, differing):
    for pk in (differing.pk, differing.follows_id):
        page = anna.get(f"/w/home/queue/{pk}/")
        assert {each.annotator.username for each in page.context["labels"]} <= {"anna"}
        assert "go(⟨room⟩)" not in page.text


def test_a_third_person_compares_both_and_takes_one(tiny_world, rene, differing):
    rene.post(reverse("queue_next", args=["home"]))
    page = rene.get(f"/w/home/queue/{differing.pk}/")
    assert [each.annotator.username for each in page.context["labels"]] == ["anna", "berta"]
    assert 'name="choice"' in page.text
    choice = page.context["labels"][1].pk
    settle = reverse("queue_settle", args=["home", differing.pk])
    assert rene.post(settle, {"choice": choice}).status_code == 302
    differing.utterance.refresh_from_db()
    assert differing.utterance.logical_form == GO
    after = rene.get(f"/w/home/queue/{differing.pk}/")
    assert after.context["form"] is None and 'name="choice"' not in after.text


@pytest.mark.parametrize(
    ("sent", "form"),
    [
        ({"choice": "unknown"}, ""),
        ({"choice": "other", "form": '(go "<name>")'}, '( go " <name> " )'),
    ],
)
def test_a_third_person_writes_another_answer(tiny_world, adam, differing, sent, form):
    act(adam, differing, "take")
    adam.post(reverse("queue_settle", args=["home", differing.pk]), sent)
    differing.utterance.refresh_from_db()
    assert differing.utterance.logical_form == form
    assert differing.utterance.status != "unlabelled"


@pytest.mark.parametrize(
    "sent", [{}, {"choice": "other", "form": "(go"}, {"choice": "other"}, {"choice": "9999999"}]
)
def test_what_is_no_answer_is_refused_with_a_sentence(tiny_world, adam, differing, sent):
    act(adam, differing, "take")
    page = adam.post(reverse("queue_settle", args=["home", differing.pk]), sent)
    assert page.status_code == 422
    assert page.context["form"].errors


def test_who_does_not_hold_it_settles_nothing(tiny_world, anna, differing):
    settle = reverse("queue_settle", args=["home", differing.pk])
    answer = anna.post(settle, {"choice": "unknown"}, follow=True)
    assert levels(answer) == ["error"]
    differing.utterance.refresh_from_db()
    assert differing.utterance.status == "unlabelled"


@pytest.mark.parametrize("kind", ["utterance", "template", "paraphrase"])
def test_a_reviewer_asks_for_a_look(tiny_world, rene, anna, item, kind):
    rows = {
        "utterance": item.utterance,
        "template": tiny_world.grammar.templates.first(),
        "paraphrase": paraphrase_in(tiny_world),
    }
    path = reverse("queue_ask", args=["home", kind, rows[kind].pk])
    assert f'action="{path}"' in rene.get(f"/w/home/{kind}s/{rows[kind].pk}/").text
    assert f'action="{path}"' not in anna.get(f"/w/home/{kind}s/{rows[kind].pk}/").text
    sent = ({"reason": "Which tea?"}, {"reason": "Again"}, {})
    told = [levels(rene.post(path, each, follow=True)) for each in sent]
    assert told == [["success"], ["info"], ["error"]]
    reason = tiny_world.work_items.get(kind="requested").reason
    assert reason.startswith("rene ") and reason.endswith(" Which tea?")
    assert rene.post(reverse("queue_ask", args=["home", "world", 1])).status_code == 404


def test_an_admin_sets_the_shares(tiny_world, adam, item):
    sent = {"unlabelled": 100, "low_confidence": 5, "disagreement": 0, "requested": 0}
    assert adam.post("/w/home/queue/settings/", sent).status_code == 302
    item.refresh_from_db()
    assert item.people == 2
    page = adam.post("/w/home/queue/settings/", {**sent, "requested": 101})
    assert page.context["form"].has_error("requested", "max_value")


def test_agreement_says_what_the_figures_mean(tiny_world, anna, adam, differing):
    page = anna.get("/w/home/queue/agreement/")
    report = page.context["report"]
    assert report.overall.items == 1
    assert all(" 0 % of 1 " in each.meaning for _, each in page.context["coefficients"][:1])
    assert (report.unsettled, report.disagreements) == (1, [])  # a third person is still asked
    act(adam, differing, "take")
    adam.post(reverse("queue_settle", args=["home", differing.pk]), {"choice": "unknown"})
    report = anna.get("/w/home/queue/agreement/").context["report"]
    assert (report.unsettled, report.disagreements[0].count) == (0, 1)


def test_agreement_without_any_says_what_to_do(tiny_world, adam, anna):
    pages = [browser.get("/w/home/queue/agreement/").text for browser in (adam, anna)]
    assert all('<div class="empty">' in page for page in pages)
    assert ['role="button" class="primary"' in page for page in pages] == [True, False]


def test_progress_counts_what_people_have_done_today(tiny_world, anna, differing):
    page = anna.get("/w/home/queue/progress/")
    assert [(row.person, row.total) for row in page.context["progress"].people] == [
        ("anna", 1),
        ("berta", 1),
    ]
    assert page.context["chart"]["series"][0] == {"name": "anna", "values": [1]}
