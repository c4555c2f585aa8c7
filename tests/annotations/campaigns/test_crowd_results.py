"""Results of a crowd market: checked, confirmed, imported as submissions that wait."""

from __future__ import annotations

import io
import logging
import zipfile

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.db import connection
from django.test.utils import CaptureQueriesContext

from annotations import background
from annotations.background import Stopped
from annotations.background.carrying_out_jobs import carry_out
from annotations.background.job_files import folder_of, jobs_folder
from annotations.background.progress import Unwatched
from annotations.background.requesting import answer_job, cancel_job
from annotations.campaigns import crowd_jobs, crowd_results
from annotations.campaigns.answering import save_answer
from annotations.campaigns.campaign_files import task_file
from annotations.campaigns.crowd_jobs import read_results, start_results_import
from annotations.campaigns.crowd_results import new_campaign, plan_results, store_results
from annotations.campaigns.model_rewrites import ModelSettings, model_contributor, store_rewrites
from annotations.campaigns.moderation import accept
from annotations.campaigns.progress import progress_of
from annotations.campaigns.pseudonyms import pseudonym_of
from annotations.campaigns.tasks import begin
from annotations.language.texts.errors import LanguageError, Refusal
from annotations.models import Campaign, Contributor, Job, Paraphrase, Submission
from annotations.models.campaigns import ContributorKind
from tests.crowd_tables import FIND, GO, results
from tests.launched_campaigns import small_campaign
from tests.work import growth

SAID = {"1": "head into the study", "2": "look for an apple", "free": "water the plants please"}


@pytest.fixture(autouse=True)
def own_folder(settings, tmp_path):
    settings.VAR_DIR = tmp_path


def send(world, by, data, file="results.csv", **options) -> Job:
    """Let a worker check a table, and return the job."""
    if "campaign" not in options:
        options.setdefault("name", "market")
    job = start_results_import(world, SimpleUploadedFile(file, data), by, **options)
    return carried_out(job)


def carried_out(job: Job) -> Job:
    carry_out(background.claim("a worker", "quick", Job, job))
    job.refresh_from_db()
    return job


def confirm(job: Job, by) -> Job:
    return carried_out(answer_job(job, by))


def taken_in(world, by, data, **options) -> Job:
    job = send(world, by, data, **options)
    assert job.is_waiting_for_answer, (job.failure, job.report)
    return confirm(job, by)


def codes(row: Submission) -> list[str]:
    return [flag["code"] for flag in row.flags]


def test_nothing_is_imported_before_somebody_confirms(world, admin):
    job = send(
        world, admin, results([SAID, {"worker": "W2", **SAID, "AssignmentStatus": "Rejected"}])
    )
    counts = job.report["counts"]
    assert job.is_waiting_for_answer and not Campaign.objects.exists()
    assert (counts["workers"], counts["rewrites"], counts["free_commands"]) == (1, 2, 1)
    assert (counts["rejected"], counts["prompts"]) == (1, 2)
    assert [each["line"] for each in job.report["examples"]] == [2, 2, 2]
    done = confirm(job, admin)
    assert done.status == "succeeded" and done.report["counts"] == counts
    assert not folder_of(job).exists() and not folder_of(done).exists()
    job.refresh_from_db()
    assert "examples" not in job.report and "examples" not in done.report


def test_prompts_of_elsewhere_make_a_closed_campaign(household, admin):
    taken_in(household, admin, results([SAID]))
    campaign = Campaign.objects.get(name="market")
    assert campaign.is_over and (campaign.task_size, campaign.free_commands) == (2, 1)
    go, find = campaign.prompts.all()
    assert (go.prompt, go.logical_form, go.grounded_form) == GO
    assert (find.position, find.command_text) == (2, FIND[0])
    assert [each["text"] for each in go.entities] == ["study"]
    assert progress_of(campaign).waiting == 3 and progress_of(campaign).per_hour == 0


def test_a_prompt_with_class_tokens_gets_the_entities_of_its_form(household, admin):
    prompt = ("go to the <room>", GO[1], GO[2])
    taken_in(household, admin, results([{"1": "walk there"}], [prompt]))
    row = Campaign.objects.get().prompts.get()
    assert (row.prompt, row.shown) == ("go to the study", "go to the study")
    assert codes(Submission.objects.get()) == ["lost_entity"]


def test_the_published_example_comes_in(shared_data, world, admin):
    data = (shared_data / "inputs" / "09-crowd-csv" / "results.csv").read_bytes()
    done = taken_in(world, admin, data)
    row = Submission.objects.get()
    assert row.text == "Would you head into the study, please?"
    assert (row.prompt.prompt, row.seconds, row.flags) == ("go to the study", 71.0, [])
    assert (done.report["counts"]["rejected"], done.report["counts"]["comments"]) == (1, 1)


def test_the_task_file_of_a_campaign_comes_back_with_answers(household, launched, admin):
    campaign = launched(task_size=3)
    head, *rows = b"".join(task_file(campaign, 4)).decode().splitlines()
    head = ",".join(f"Input.{name}" for name in head.split(","))
    answers = [f"go and do {row} {cell}" for row in "abcd" for cell in "xyz"]
    lines = [
        f"W{number},90,{row},{','.join(answers[3 * number : 3 * number + 3])}"
        for number, row in enumerate(rows)
    ]
    head = (
        f"WorkerId,WorkTimeInSeconds,{head},{','.join(f'Answer.utterance{n}' for n in (1, 2, 3))}"
    )
    taken_in(household, admin, "\n".join([head, *lines]).encode(), campaign=campaign)
    submissions = Submission.objects.filter(contributor__kind=ContributorKind.FILE)
    assert [each.text for each in submissions.order_by("pk")] == answers
    assert {each.prompt.campaign for each in submissions} == {campaign}
    assert {each.seconds for each in submissions} == {30.0}
    assert campaign.prompts.filter(submissions__isnull=False).distinct().count() > 3
    accept(list(submissions), admin)
    assert Paraphrase.objects.filter(contributor__campaign=campaign).count() == len(answers)


def test_a_worker_has_the_pseudonym_that_the_link_gives_them(world, admin):
    campaign = small_campaign(world)
    prompt = campaign.prompts.first()
    begin(campaign, pseudonym_of(campaign, "workerId", "W1"))
    table = results([{"1": "get the apple"}], [(prompt.shown, "", "")])
    taken_in(world, admin, table, campaign=campaign)
    assert list(campaign.contributors.values_list("pseudonym", "attempt", "kind")) == [
        (pseudonym_of(campaign, "workerId", "W1"), 1, "person"),
        (pseudonym_of(campaign, "workerId", "W1"), 2, "file"),
    ]


def test_the_id_of_a_worker_stands_nowhere(world, admin, caplog):
    caplog.set_level(logging.DEBUG)
    secret = "A1B2C3SECRET"
    table = results([{"worker": secret, **SAID}, {"worker": secret, **SAID, "1": "x" * 600}])
    with CaptureQueriesContext(
        connection,
    ) as queries:
        taken_in(world, admin, table)
        job = send(
            world,
            admin,
            results([{"worker": secret, "Input.parse_ground1": "( go", **SAID}]),
            name="again",
        )
    assert job.status == "failed" and job.report["problems"]
    assert not any(secret in query["sql"] for query in queries.captured_queries)
    assert secret not in caplog.text
    assert not list(jobs_folder().rglob("*"))


def test_the_same_file_twice_adds_nothing(world, admin):
    rows = [{"worker": f"W{number}", **SAID, "1": f"go {number} study"} for number in range(3)]
    taken_in(world, admin, results(rows))
    campaign = Campaign.objects.get()
    again = send(world, admin, results([*rows, rows[0]]), campaign=campaign)
    assert again.status == "succeeded" and not again.is_waiting_for_answer
    assert again.report["counts"]["repeated"] == 4 and again.report["counts"]["assignments"] == 0
    more = taken_in(
        world, admin, results([*rows, {**rows[0], "1": "enter the study"}]), campaign=campaign
    )
    assert more.report["counts"]["assignments"] == 1
    assert Contributor.objects.count() == 4 and Submission.objects.count() == 12


def test_of_two_who_confirm_the_same_file_one_imports_it(world, admin):
    campaign = small_campaign(world)
    table = results(
        [{"1": "get it", "free": "dance a bit"}], [(campaign.prompts.first().shown, "", "")]
    )
    asked = [send(world, admin, table, campaign=campaign) for _ in range(2)]
    done = [confirm(job, admin) for job in asked]
    assert [job.report["counts"]["assignments"] for job in done] == [1, 0]
    assert Contributor.objects.count() == 1


def test_flags_are_those_of_the_public_page(world, admin):
    """The same answers, written on the page one after another, and in a file."""
    by_page, by_file = small_campaign(world), small_campaign(world, name="second")
    apple, people = by_page.prompts.values_list("shown", flat=True)
    tasks = [
        (apple, "get the things"),  # lost
        (people, "get the things"),  # a repeat of one's own
        (apple, apple),
        (people, "asdf qwer zxcv"),
        (apple, "Fetch me the apple!"),
        (people, "say who is in the living room"),
        (apple, "please fetch me the apple"),  # a repeat of another's
        (people, "count the people in the living room now"),
    ]
    free = [
        "dance",
        "bring me the apple from the kitchen table",
        "asdf jklö qwer",
        "water the plants",
    ]
    for campaign in (by_page, by_file):
        settings = ModelSettings("m", "{command}")
        model = model_contributor(campaign, settings)
        store_rewrites(
            model, campaign.prompts.last(), "", ["count the peoples in the living room now"]
        )
    rows = []
    for number, said in enumerate(free):
        (_, first), (_, second) = tasks[2 * number : 2 * number + 2]
        contributor = begin(by_page, f"p{number}")
        places = list(contributor.submissions.order_by("position"))
        in_order = sorted(places[:2], key=lambda place: place.prompt.position)
        for place, text in zip([*in_order, places[2]], (first, second, said), strict=True):
            save_answer(place, text, 40)
        rows.append({"worker": f"W{number}", "1": first, "2": second, "free": said})
    table = results(rows, [(apple, "", ""), (people, "", "")])
    taken_in(world, admin, table, campaign=by_file)

    def flags_in(campaign: Campaign) -> list[tuple[str, object]]:
        rows = Submission.objects.filter(contributor__campaign=campaign).exclude(
            contributor__kind=ContributorKind.MODEL
        )
        return sorted(((row.text, row.flags) for row in rows), key=repr)

    assert flags_in(by_page) == flags_in(by_file)
    given = {code for _, flags in flags_in(by_file) for code in (flag["code"] for flag in flags)}
    assert given == {"copy", "repeat", "lost_entity", "gibberish", "spam", "like_model"}


def test_who_was_too_fast_is_told_by_the_time_of_the_whole_task(world, admin):
    taken_in(world, admin, results([{**SAID, "WorkTimeInSeconds": "3"}]))
    rewrites = Submission.objects.exclude(prompt=None)
    assert {row.seconds for row in rewrites} == {1.0}
    assert all("too_fast" in codes(row) for row in rewrites)


def test_an_error_refuses_the_whole_file_and_names_line_and_cell(world, admin):
    table = results([SAID, {**SAID, "Input.parse_ground2": "( find"}]) + b"W9,Approved\r\n"
    job = send(world, admin, table)
    assert job.status == "failed" and not job.is_waiting_for_answer
    places = [(each["line"], each["column"], each["severity"]) for each in job.report["problems"]]
    assert places == [(3, 9, "error"), (4, 1, "error")]
    with pytest.raises(Refusal):
        answer_job(job, admin)
    assert not Campaign.objects.exists() and not folder_of(job).exists()


def test_answers_to_no_prompt_of_the_campaign_are_left_out_with_their_line(world, admin):
    campaign = small_campaign(world)
    shown = campaign.prompts.first().shown
    table = results([{"1": "get it", "2": "go"}], [(shown, "", ""), ("jump", "", "")])
    job = send(world, admin, table, campaign=campaign)
    assert job.is_waiting_for_answer and job.report["counts"]["unmatched"] == 1
    (problem,) = job.report["problems"]
    assert (problem["line"], problem["severity"]) == (2, "warning")
    other = send(world, admin, results([SAID]), campaign=campaign)
    assert other.status == "failed"
    wrong = results([{"1": "get it"}], [(shown, "", '( go " study " )')])
    assert send(world, admin, wrong, campaign=campaign).status == "failed"


def test_a_new_campaign_needs_forms_and_a_name_of_its_own(world, admin):
    bare = results([{"1": "go"}], [("go there", "", "")])
    assert send(world, admin, bare).status == "failed"
    first, second = (send(world, admin, results([SAID])) for _ in range(2))
    confirm(first, admin)
    refused = confirm(second, admin)
    assert refused.status == "failed" and "market" in refused.failure
    with pytest.raises(Refusal):
        send(world, admin, results([SAID]))
    assert Campaign.objects.count() == 1


@pytest.mark.parametrize("codec", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "windows-1252"])
def test_encodings_are_recognised_or_told(world, admin, codec):
    table = results([{**SAID, "1": "head into the café of the study, s’il vous plaît"}]).decode()
    told = codec if codec == "windows-1252" else ""
    job = send(world, admin, table.encode(codec), encoding=told)
    assert job.is_waiting_for_answer, job.failure
    assert job.report["examples"][0]["text"].startswith("head into the café")


def test_a_table_may_come_in_an_archive(world, admin):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("batch/results.csv", results([SAID]))
        archive.writestr("batch/readme.txt", "none")
    assert send(world, admin, packed.getvalue(), file="batch.zip").is_waiting_for_answer
    empty = io.BytesIO()
    with zipfile.ZipFile(empty, "w") as archive:
        archive.writestr("readme.txt", "none")
    assert send(world, admin, empty.getvalue(), file="batch.zip").status == "failed"


def test_a_file_that_is_too_large_is_refused_before_it_is_read(monkeypatch):
    monkeypatch.setattr(crowd_jobs, "MOST_BYTES", 100)
    with pytest.raises(LanguageError):
        read_results(SimpleUploadedFile("results.csv", results([SAID])))


@pytest.mark.parametrize("data", [b"\x00\x01\x02" * 90, b"PK\x03\x04", b" \n ", b"a;b\n1;2\n"])
def test_what_is_no_table_of_results_fails_with_a_sentence(world, admin, data):
    job = send(world, admin, data)
    assert job.status == "failed" and "fault" not in job.failure


class Stopping(Unwatched):
    """Stops a verb when it has been asked so many times."""

    def __init__(self, after: int) -> None:
        self.after = after

    def check(self) -> None:
        self.after -= 1
        if self.after < 0:
            raise Stopped("somebody cancelled")


@pytest.mark.parametrize("after", [0, 1, 2])
def test_who_cancels_while_it_writes_leaves_nothing(world, admin, after, monkeypatch):
    monkeypatch.setattr(crowd_results, "BATCH", 1)
    table, _ = read_results(SimpleUploadedFile("results.csv", results([SAID])))
    campaign = new_campaign(world, "market", table, admin)
    plan = plan_results(campaign, table, "results.csv")
    with pytest.raises(Stopped):
        store_results(plan, table, admin, Stopping(after))
    assert not Campaign.objects.exists() and not Submission.objects.exists()


def test_who_drops_the_question_deletes_the_file(world, admin, django_capture_on_commit_callbacks):
    job = send(world, admin, results([SAID]))
    assert folder_of(job).exists()
    with django_capture_on_commit_callbacks(execute=True):
        cancel_job(job)
    assert not folder_of(job).exists() and not Submission.objects.exists()


def test_flags_cost_linear_time(world):
    """Everybody answers the same prompt: each answer is compared with all earlier ones."""

    def plan(size: int):
        rows = [{"worker": f"W{n}", "1": f"go {n} to the study"} for n in range(size)]
        table, _ = read_results(SimpleUploadedFile("results.csv", results(rows)))
        campaign = new_campaign(world, "market", table, None)
        return lambda: plan_results(campaign, table, "results.csv")

    assert growth(plan, 300) < 2.3


def test_an_assignment_is_known_again_by_its_id(world, admin):
    first = {**SAID, "AssignmentId": "A1"}
    taken_in(world, admin, results([first, {**SAID, "AssignmentId": "A2"}]))
    assert Contributor.objects.count() == 2
    campaign = Campaign.objects.get()
    changed = results([{**first, "1": "walk into the study"}, {**SAID, "AssignmentId": "A3"}])
    done = taken_in(world, admin, changed, campaign=campaign)
    assert done.report["counts"]["repeated"] == 1 and Contributor.objects.count() == 3
    assert not any("A1" in str(each) for each in Contributor.objects.values())


def test_what_was_imported_before_its_id_was_read_is_known_too(world, admin):
    taken_in(world, admin, results([SAID]))
    again = results([{**SAID, "AssignmentId": "A1"}])
    job = send(world, admin, again, campaign=Campaign.objects.get())
    assert job.report["counts"]["repeated"] == 1 and not job.is_waiting_for_answer
