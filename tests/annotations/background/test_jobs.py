"""Jobs do what the verbs do, with the files of the request, and leave nothing behind."""

from __future__ import annotations

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations import background
from annotations.background.carrying_out_jobs import carry_out, verb_of
from annotations.background.job_files import folder_of, jobs_folder
from annotations.background.requesting import answer_job, cancel_job, request_job
from annotations.background.sweeping import sweep
from annotations.background.watching import JobProgress
from annotations.exchange import world_import
from annotations.exchange.generator_import import import_generator
from annotations.exchange.hidden_worlds import hidden_name
from annotations.exchange.world_deletion import request_deletion
from annotations.generation.generating import generate_pairs
from annotations.language.texts.errors import Refusal
from annotations.models import Job, JobKind, World
from annotations.models.background import Status
from tests.annotations.conftest import TINY, as_bytes
from tests.annotations.exchange.packing import everything_of, pack
from tests.annotations.rows_of import contents_of, rows_of
from tests.annotations.web.worlds.test_import_pages import archive, uploads


@pytest.fixture(autouse=True)
def var_dir(settings, tmp_path):
    settings.VAR_DIR = tmp_path


@pytest.fixture
def home(transactional_db) -> World:
    return World.objects.create(name="home")


@pytest.fixture
def tiny() -> dict[str, bytes]:
    return as_bytes(TINY)


def done(job: Job) -> Job:
    """The job after a worker has carried it out."""
    claimed = background.claim("a worker", "quick", Job, job)
    carry_out(claimed)
    job.refresh_from_db()
    return job


def files_left() -> list[str]:
    return [path.name for path in jobs_folder().glob("*")]


@pytest.mark.parametrize("kind", JobKind)
def test_each_kind_of_job_has_its_verb(kind):
    assert callable(verb_of(kind))


def test_an_import_of_generator_files(home, tiny):
    job = done(request_job(JobKind.IMPORT_GENERATOR, "home", None, uploads=uploads(tiny)))
    assert (job.status, job.failure) == (Status.SUCCEEDED, "")
    assert job.report["templates"] == {"1": 2}
    import_generator("other", tiny)
    assert contents_of(home) == contents_of(World.objects.get(name="other"))
    assert files_left() == []


def test_errors_fail_the_job_and_are_in_its_report(home, tiny):
    tiny["names.xml"] = b""
    job = done(request_job(JobKind.IMPORT_GENERATOR, "home", None, uploads=uploads(tiny)))
    assert job.status == Status.FAILED and "1 " in job.failure
    assert job.report["problems"][0]["file"] == "names.xml"


def test_an_import_that_would_remove_something_asks_first(home, tiny):
    import_generator("home", tiny)
    before = rows_of(home)
    del tiny["locations.xml"]
    job = done(request_job(JobKind.IMPORT_GENERATOR, "home", None, uploads=uploads(tiny)))
    assert job.is_waiting_for_answer
    assert len(job.report["removals"]["entities"]) == 4
    assert rows_of(home) == before and files_left() == [str(job.pk)]
    answer = done(answer_job(job, None))
    assert (answer.status, answer.report["changes"]["removed"]) == (Status.SUCCEEDED, 4)
    assert home.ontology.entities.count() == 3 and files_left() == []
    job.refresh_from_db()
    with pytest.raises(Refusal) as refused:
        answer_job(job, None)
    assert (refused.value.code, refused.value.status) == ("already_answered", 409)


def test_an_import_that_asks_is_dropped(home, tiny):
    import_generator("home", tiny)
    del tiny["locations.xml"]
    job = done(request_job(JobKind.IMPORT_GENERATOR, "home", None, uploads=uploads(tiny)))
    cancel_job(job)
    job.refresh_from_db()
    assert not job.is_waiting_for_answer and files_left() == []


def test_published_pairs(home):
    pairs = {"gen/train.txt": b'go to the <room>\n( go " <room> " )\n'}
    request = request_job(JobKind.IMPORT_PAIRS, "home", None, {"name": "w"}, [archive(pairs)])
    assert done(request).status == Status.SUCCEEDED
    assert home.splits.get().name == "w-command"


def test_generation(home, tiny):
    import_generator("home", tiny)
    job = done(request_job(JobKind.GENERATE, "home", None))
    assert job.report["commands"] == {"1": 3, "all": 3}
    assert home.commands.count() == 3


def test_a_limit_that_is_passed_is_the_failure(home, tiny):
    import_generator("home", tiny)
    job = done(request_job(JobKind.GENERATE, "home", None, {"limit": 2}))
    assert job.status == Status.FAILED and " 2" in job.failure


def test_a_world_from_its_archive(home, tiny):
    import_generator("home", tiny)
    upload = SimpleUploadedFile("home-world.zip", pack(home).read())
    job = done(request_job(JobKind.IMPORT_WORLD, "again", None, uploads=[upload]))
    assert (job.status, job.failure) == (Status.SUCCEEDED, "")
    assert everything_of(World.objects.get(name="again")) == everything_of(home)


def test_deletion(home, tiny):
    import_generator("home", tiny)
    request_deletion(home)
    assert done(request_job(JobKind.DELETE_WORLD, "home", None)).report["rows"] > 10
    assert not World.objects.exists()


def test_a_deletion_is_not_stopped(home):
    request_deletion(home)
    with pytest.raises(Refusal) as refused:
        cancel_job(request_job(JobKind.DELETE_WORLD, "home", None))
    assert (refused.value.code, refused.value.status) == ("deletion_goes_on", 409)


@pytest.mark.parametrize("kind", [JobKind.IMPORT_GENERATOR, JobKind.GENERATE])
def test_a_job_that_is_no_longer_ours_changes_nothing(home, tiny, kind, monkeypatch):
    import_generator("home", tiny)
    before = rows_of(home)
    tiny["tiny_category_1_semantics.txt"] += b"visit the {room} = (go {room})\n"
    files = uploads(tiny) if kind == JobKind.IMPORT_GENERATOR else []
    job = request_job(kind, "home", None, uploads=files)

    def lose(progress, fraction, message):
        if message == "writing":
            Job.objects.filter(pk=job.pk).update(attempt=7)

    monkeypatch.setattr(JobProgress, "report", lose)
    done(job)
    assert rows_of(home) == before


def test_a_job_cancelled_in_the_middle_changes_nothing(home, tiny, monkeypatch):
    job = request_job(JobKind.IMPORT_GENERATOR, "home", None, uploads=uploads(tiny))
    report = JobProgress.report

    def stop(progress, fraction, message):
        if message == "writing":
            raise background.Stopped
        report(progress, fraction, message)

    monkeypatch.setattr(JobProgress, "report", stop)
    assert done(job).status == Status.CANCELLED
    assert not hasattr(World.objects.get(name="home"), "grammar")
    assert files_left() == []


def test_a_job_cancelled_while_it_waits_leaves_no_file(home, tiny):
    job = request_job(JobKind.IMPORT_GENERATOR, "home", None, uploads=uploads(tiny))
    assert files_left() == [str(job.pk)]
    cancel_job(job)
    assert files_left() == [] and job.status == Status.CANCELLED


def test_an_interrupted_import_of_a_world_starts_over(home, tiny, monkeypatch):
    import_generator("home", tiny)
    upload = SimpleUploadedFile("home-world.zip", pack(home).read())
    job = request_job(JobKind.IMPORT_WORLD, "again", None, uploads=[upload])
    with monkeypatch.context() as patch:
        patch.setattr(world_import, "delete_world", lambda world: None)
        patch.setattr(world_import, "_check_world", lambda world: 1 / 0)
        with pytest.raises(ZeroDivisionError), upload.open() as file:
            world_import.import_world("again", file, hidden_name=hidden_name(job))
    assert World.objects.filter(name=hidden_name(job)).exists()
    assert done(job).status == Status.SUCCEEDED
    assert set(World.objects.values_list("name", flat=True)) == {"home", "again"}


def test_what_jobs_left_is_swept(home, tiny):
    job = request_job(JobKind.IMPORT_GENERATOR, "home", None, uploads=uploads(tiny))
    Job.objects.filter(pk=job.pk).update(status=Status.LOST)
    hidden = World.objects.create(name=hidden_name(job))
    request_deletion(hidden)
    sweep()
    assert not folder_of(job).exists()
    assert set(World.objects.values_list("name", flat=True)) == {"home"}


def test_what_active_jobs_need_is_not_swept(home, tiny):
    job = request_job(JobKind.IMPORT_GENERATOR, "home", None, uploads=uploads(tiny))
    request_deletion(World.objects.create(name=hidden_name(job)))
    request_deletion(World.objects.create(name="half-deleted"))
    sweep()
    assert folder_of(job).exists()
    assert World.objects.count() == 3


def test_the_commands_of_a_world_meanwhile_generated_by_others(home, tiny, monkeypatch):
    """Somebody else generates between reading and writing: nothing is written twice."""
    import_generator("home", tiny)
    job = request_job(JobKind.GENERATE, "home", None)
    others = iter([lambda: generate_pairs(home)])
    report = JobProgress.report

    def interfere(progress, fraction, message):
        report(progress, fraction, message)
        if message == "writing":
            next(others, lambda: None)()

    monkeypatch.setattr(JobProgress, "report", interfere)
    assert done(job).report["changes"] == {"added": 0, "changed": 0, "removed": 0, "moved": 0}
    assert home.commands.count() == 3


def test_an_error_analysis_says_of_which_run(home):
    job = Job(world=home, kind=JobKind.ANALYSE, arguments={"run": 7})
    assert job.title == "Error analysis of run 7"
    assert Job(world=home, kind=JobKind.GENERATE).title == "Generation of commands"


def test_an_archive_that_is_refused_leaves_no_traceback(home, caplog):
    broken = SimpleUploadedFile("home.zip", b"PK\x03\x04" + b"\xff" * 50)
    job = done(request_job(JobKind.IMPORT_WORLD, "copy", None, uploads=[broken]))
    assert job.status == Status.FAILED and "home.zip" in job.failure
    assert [record for record in caplog.records if record.exc_info] == []
