"""The files of a campaign: tasks for a crowd market, submissions, triples."""

from __future__ import annotations

import csv
import io

from annotations.campaigns.answering import save_answer
from annotations.campaigns.campaign_files import (
    FIELDS,
    accepted_triples,
    submission_table,
    task_file,
)
from annotations.campaigns.moderation import accept
from annotations.campaigns.tasks import begin
from annotations.exchange.pair_import import import_pairs
from annotations.language.corpus import read_triples
from annotations.models import CampaignPrompt, Paraphrase, Submission
from tests.launched_campaigns import small_campaign


def rows_of(pieces) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(b"".join(pieces).decode(), newline="")))


def test_a_task_is_a_row_with_prompts_of_different_forms(launched):
    campaign = launched(task_size=3)
    rows = rows_of(task_file(campaign, 20))
    assert len(rows) == 20
    names = [f"{name}{n}" for n in (1, 2, 3) for name in ("command", "parse", "parse_ground")]
    assert list(rows[0]) == names
    known = set(campaign.prompts.values_list("shown", "logical_form", "grounded_form"))
    for row in rows:
        texts = list(row.values())
        assert {tuple(texts[at : at + 3]) for at in (0, 3, 6)} <= known
        assert len({row[f"parse{number}"] for number in (1, 2, 3)}) == 3


def test_tasks_go_evenly_over_forms_and_first_to_those_with_fewest(launched):
    campaign = launched(task_size=4)
    forms = set(campaign.prompts.values_list("logical_form", flat=True))
    contributor = begin(campaign, "somebody")
    had = {place.prompt.logical_form for place in contributor.submissions.exclude(prompt=None)}
    tasks = (len(forms) - len(had)) // 4
    dealt = [row[f"parse{n}"] for row in rows_of(task_file(campaign, tasks)) for n in range(1, 5)]
    assert len(dealt) == len(set(dealt)) and not had & set(dealt)


def test_a_campaign_with_fewer_prompts_than_a_task_leaves_cells_empty(world):
    (row,) = rows_of(task_file(small_campaign(world, task_size=3), 1))
    assert row["command1"] and row["command2"] and row["command3"] == ""


def test_no_cell_is_a_formula(world):
    campaign = small_campaign(world)
    CampaignPrompt.objects.update(shown="=HYPERLINK(1)")
    (row,) = rows_of(task_file(campaign, 1))
    assert row["command1"] == "'=HYPERLINK(1)"


def test_submissions_come_as_a_table_with_pseudonyms(world):
    campaign = small_campaign(world)
    first, _, free = begin(campaign, "f00d").submissions.order_by("position")
    save_answer(first, "=1+1", 9)
    save_answer(free, "say “hi, you”", 9)
    rows = rows_of(submission_table(Submission.objects.answered()))
    assert tuple(rows[0]) == FIELDS
    assert [(row["text"], row["contributor"], row["kind"]) for row in rows] == [
        ("'=1+1", "f00d", "rewrite"),
        ("say “hi, you”", "f00d", "free"),
    ]


def test_accepted_rewrites_read_back_as_triples(household, launched, admin, tmp_path):
    campaign = launched(task_size=3, free_commands=1)
    places = list(begin(campaign, "somebody").submissions.order_by("position"))
    for number, place in enumerate(places):
        save_answer(place, f"do, please, number {number}", 9)
    accept([places[0], places[2], places[3]], admin)
    data = b"".join(accepted_triples(campaign))
    read = read_triples(data, "paraphrasings.txt")
    assert not read.problems
    assert [(each.paraphrase, each.command, each.canonical_form) for each in read.records] == [
        (f"do, please, number {number}", place.prompt.prompt, place.prompt.grounded_form)
        for number, place in ((0, places[0]), (2, places[2]))
    ]
    (tmp_path / "paraphrasings.txt").write_bytes(data)
    before = set(Paraphrase.objects.values_list("utterance", "logical_form", "grounded_form"))
    import_pairs("elsewhere", "back", tmp_path)
    there = Paraphrase.objects.filter(world__name="elsewhere")
    texts = set(there.values_list("utterance", "grounded_form"))
    assert texts == {(text, grounded) for text, _, grounded in before}
