"""Importing by upload: several files or an archive, all or nothing."""

from __future__ import annotations

import io
import zipfile

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.editing.edits import delete
from annotations.models import AuditEntry, Job, SemanticTemplate
from tests.annotations.conftest import TINY, as_bytes
from tests.gpsr_site.routes.sample_rows import campaign_row, submission, utterance
from tests.sample_world import paraphrase_in


def uploads(files):
    return [SimpleUploadedFile(name, data) for name, data in files.items()]


def archive(files, name="generator.zip"):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for member, data in files.items():
            archive.writestr(member, data)
    return SimpleUploadedFile(name, packed.getvalue())


@pytest.fixture
def tiny():
    return as_bytes(TINY)


def send(client, files):
    return client.post("/w/home/import/", {"files": files})


def report_of(client, answer):
    """The page of the job that an import leads to, which can be reloaded."""
    assert answer.status_code == 302
    return client.get(answer["Location"])


def test_several_files_are_one_import(world, adam, tiny):
    answer = send(adam, uploads(tiny))
    assert answer.status_code == 302
    assert SemanticTemplate.objects.filter(grammar__world=world).count() == 2


def test_an_archive_is_one_import_whatever_its_folders(world, adam, tiny):
    nested = {f"generator/{name}": data for name, data in tiny.items()}
    assert send(adam, [archive(nested)]).status_code == 302
    assert SemanticTemplate.objects.filter(grammar__world=world).count() == 2


def test_the_same_files_again_change_nothing(world, adam, tiny):
    send(adam, uploads(tiny))
    report = report_of(adam, send(adam, uploads(tiny))).context["report"]
    assert set(report["changes"].values()) == {0}


def test_one_error_refuses_everything_and_is_shown_with_its_place(world, adam, tiny):
    tiny["tiny_category_1_semantics.txt"] = b"go to the {room} = (go $1)\n"
    sent = send(adam, uploads(tiny))
    for _ in range(2):  # also after a reload
        answer = report_of(adam, sent)
        page = answer.content.decode()
        assert answer.context["is_refused"]
        assert "tiny_category_1_semantics.txt:1:" in page
        assert 'href="/w/home/import/"' in page.partition("<main")[2]
    assert not hasattr(world, "grammar")
    job = Job.objects.get()
    assert (job.status, job.failure) == ("failed", "Nothing was imported: 1 error.")
    assert AuditEntry.objects.latest("pk").subject == job.failure


def test_an_error_of_the_files_as_a_whole_has_no_place(world, adam):
    sent = send(adam, uploads({"names.xml": b"<names><name>Ada</name></names>"}))
    answer = report_of(adam, sent)
    (problem,) = [each for each in answer.context["problems"] if each["severity"] == "error"]
    assert problem["file"] == "" and problem["message"] in answer.content.decode()
    assert ":1:1" not in answer.content.decode()


def test_no_file_is_told(world, adam):
    assert adam.post("/w/home/import/").context["form"].has_error("files", "required")


@pytest.mark.parametrize(
    ("files", "named"),
    [
        ([SimpleUploadedFile("x.zip", b"PK no archive")], "x.zip"),
        ([archive({f"{n}.txt": b"x" for n in range(80)})], "64"),
    ],
)
def test_an_upload_that_cannot_be_taken_is_told_at_its_field(files, named, world, adam):
    for file in files:
        file.seek(0)
    answer = send(adam, files)
    assert answer.status_code == 422
    assert named in str(answer.context["form"].errors)


def test_two_files_of_one_name_are_told_in_the_report(world, adam):
    twice = archive({"a/x.txt": b"$Main = a\n", "b/x.txt": b"$Main = b\n"})
    assert "x.txt" in str(report_of(adam, send(adam, [twice])).context["problems"])


def test_an_archive_that_swells_is_refused_before_it_is_unpacked(world, adam, settings):
    settings.UPLOAD_MAX_BYTES = 1000
    bomb = archive({"x.txt": b"a" * 1001})
    assert "1,000" in str(send(adam, [bomb]).context["form"].errors["files"])


def test_a_name_that_leaves_its_folder_is_no_way_out(world, adam, tiny, tmp_path):
    escaping = {f"../../../{name}": data for name, data in tiny.items()}
    assert send(adam, [archive(escaping)]).status_code == 302
    assert list(tmp_path.iterdir()) == []


PAIRS = {
    "walker/gen/train.txt": b'go to the <room>\n( go " <room> " )\n',
    "walker/gen/val.txt": b'find the <object>\n( find ( lambda $1 e ( is_a $1 " <object> " ) ) )\n',
    "walker/README.md": b"not a pair file",
    "__MACOSX/._train.txt": b"\0",
}


def send_pairs(client, files, name="walker"):
    return client.post("/w/home/import/pairs/", {"name": name, "archive": archive(files)})


def test_published_pairs_become_a_frozen_split(sample, adam):
    answer = send_pairs(adam, PAIRS)
    assert report_of(adam, answer).context["report"]
    made = sample.world.splits.get(name="walker-command")
    assert [example.part for example in made.examples.all()] == ["train", "validation"]


def test_a_fault_in_the_pairs_refuses_them_with_its_place(sample, adam):
    answer = report_of(adam, send_pairs(adam, {"gen/train.txt": b"go to the <room>\n"}))
    assert answer.context["is_refused"] and "train.txt:1" in answer.content.decode()
    assert sample.world.splits.count() == 1


def test_an_archive_without_pairs_is_told(sample, adam):
    answer = report_of(adam, send_pairs(adam, {"notes/train.txt": b"x"}))
    assert answer.context["is_refused"]


def test_an_import_that_forgets_a_file_shows_what_would_go_and_asks(
    world, adam, tiny, settings, tmp_path
):
    settings.VAR_DIR = tmp_path
    send(adam, uploads(tiny))
    del tiny["tiny_category_1_semantics.txt"]
    answer = send(adam, uploads(tiny))
    page = adam.get(answer["Location"])
    job = Job.objects.latest("pk")
    assert page.context["report"]["is_waiting"]
    assert "go to the {room} = (go {room})" in page.content.decode()
    assert f'action="/jobs/{job.pk}/answer/"' in page.content.decode()
    assert SemanticTemplate.objects.count() == 2
    assert not [each for each in page.context["problems"] if each.get("url")]
    answer = adam.post(f"/jobs/{job.pk}/answer/")
    confirmed = Job.objects.latest("pk")
    assert answer["Location"] == f"/jobs/{confirmed.pk}/"
    assert confirmed.arguments["is_confirmed"] and confirmed.status == "queued"


def test_an_import_that_asks_can_be_cancelled(world, adam, tiny, settings, tmp_path):
    settings.VAR_DIR = tmp_path
    send(adam, uploads(tiny))
    del tiny["objects.xml"]
    job_page = send(adam, uploads(tiny))["Location"]
    adam.post(f"{job_page}cancel/")
    assert f'action="{job_page}answer/"' not in adam.get(job_page).content.decode()
    assert Job.objects.count() == 2


def test_large_files_become_a_job(world, adam, tiny, settings, tmp_path):
    settings.VAR_DIR = tmp_path
    tiny["objects.xml"] += b" " * 500_000
    answer = send(adam, uploads(tiny))
    job = Job.objects.get()
    assert answer["Location"] == f"/jobs/{job.pk}/"
    page = adam.get(answer["Location"]).content.decode()
    assert job.title in page and "hx-get" in page


@pytest.mark.parametrize("method", [zipfile.ZIP_DEFLATED, zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
def test_an_archive_with_a_damaged_stream_is_told_in_a_sentence(world, adam, tiny, method):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", method) as file:
        file.writestr("objects.xml", tiny["objects.xml"])
        info = file.getinfo("objects.xml")
    data = bytearray(packed.getvalue())
    start = info.header_offset + 30 + len(info.filename)
    data[start : start + info.compress_size] = b"\x99" * info.compress_size
    answer = send(adam, [SimpleUploadedFile("x.zip", bytes(data))])
    assert answer.status_code == 422
    assert list(answer.context["form"].errors) == ["files"]


@pytest.mark.parametrize("page", ["import/", "import/pairs/"])
def test_a_name_of_300_letters_or_bytes_that_are_no_text(world, adam, page):
    field = "archive" if "pairs" in page else "files"
    long = archive({f"gen/{'x' * 300}.txt": b"$Main = hello\n"}, "long.zip")
    answer = adam.post(f"/w/home/{page}", {"name": "n", field: long})
    assert answer.status_code == 422
    assert "200" in str(answer.context["form"].errors[field])
    whole = archive({"gen/ä.txt": b"$Main = hello\n"}, "bad.zip").read()
    bad = SimpleUploadedFile("bad.zip", whole.replace("ä".encode(), b"\xff\xff"))
    answer = adam.post(f"/w/home/{page}", {"name": "n", field: bad})
    assert answer.status_code == 422
    assert list(answer.context["form"].errors) == [field]


def test_a_name_of_more_bytes_than_a_folder_takes(world, adam):
    long = archive({f"gen/{'ü' * 150}.txt": b"go\n( go )\n"}, "long.zip")
    answer = adam.post("/w/home/import/pairs/", {"name": "n", "archive": long})
    assert answer.status_code == 422
    assert "255" in str(answer.context["form"].errors["archive"])


def test_an_archive_some_of_whose_paths_begin_with_a_slash(world, adam, tiny):
    files = {f"/{name}" if name.endswith(".xml") else name: data for name, data in tiny.items()}
    assert send(adam, [archive(files)]).status_code == 302
    assert world.ontology.entities.exists()


def test_what_people_deleted_is_said_and_brought_back_if_asked_for(world, adam, admin, tiny):
    send(adam, uploads(tiny))
    template = SemanticTemplate.objects.get(pattern="go to the {room}")
    delete(template, admin, 1)
    page = " ".join(report_of(adam, send(adam, uploads(tiny))).content.decode().split())
    assert f"{template} (" in page and "adam" in page.partition(f"{template} (")[2]
    assert "/w/home/history/template/deleted/" in page
    assert SemanticTemplate.objects.count() == 1
    answer = adam.post("/w/home/import/", {"files": uploads(tiny), "brings_back": "on"})
    page = report_of(adam, answer).content.decode()
    assert "/w/home/history/template/deleted/" not in page
    assert SemanticTemplate.objects.get(pk=template.pk).version == 2


def test_warnings_are_there_after_a_reload_and_lead_to_what_they_are_about(world, adam, tiny):
    tiny["tiny_category_1_grammar.txt"] += b"$nobody = somebody\n"
    tiny["objects.xml"] = tiny["objects.xml"].replace(b'room="kitchen"', b'room="attic"')
    answer = send(adam, uploads(tiny))
    problems = report_of(adam, answer).context["problems"]
    assert problems == report_of(adam, answer).context["problems"]
    (unreachable,) = [each for each in problems if each["file"] == "tiny_category_1_grammar.txt"]
    row = world.grammar.productions.get(nonterminal="nobody")
    assert unreachable["url"] == f"/w/home/grammar/{row.pk}/"
    assert unreachable["url"] in report_of(adam, answer).content.decode()
    assert all(each.get("url") for each in problems)


def test_warnings_of_one_kind_are_one_line_with_their_number_and_places(world, adam, tiny):
    tiny["tiny_category_1_grammar.txt"] += b"$nobody = somebody\n$nothing = something\n"
    tiny["objects.xml"] = tiny["objects.xml"].replace(b'room="kitchen"', b'room="attic"')
    answer = report_of(adam, send(adam, uploads(tiny)))
    groups = answer.context["problem_groups"]
    assert sum(group.count for group in groups) == len(answer.context["problems"])
    (unreached,) = [group for group in groups if group.count == 2]
    assert (unreached.title, unreached.severity) == ("$Main never reaches …", "warning")
    page = answer.content.decode()
    for name in ("nobody", "nothing"):
        row = world.grammar.productions.get(nonterminal=name)
        assert f'href="/w/home/grammar/{row.pk}/"' in page
    assert page.count(unreached.hint) == 1


def test_errors_lead_to_no_row_of_the_files_before(world, adam, tiny):
    send(adam, uploads(tiny))
    tiny["common_rules.txt"] = b"$new = (a\n" + tiny["common_rules.txt"]
    answer = report_of(adam, send(adam, uploads(tiny)))
    assert answer.context["is_refused"]
    problems = answer.context["problems"]
    assert problems and not [each for each in problems if each.get("url")]


def test_warnings_lead_to_the_rows_of_a_file_in_any_case_of_letters(world, adam, tiny):
    tiny["Objects.xml"] = tiny.pop("objects.xml").replace(b'room="kitchen"', b'room="attic"')
    answer = send(adam, uploads(tiny))
    problems = report_of(adam, answer).context["problems"]
    urls = [each.get("url", "") for each in problems if each["file"] == "Objects.xml"]
    assert urls and all(url.startswith("/w/home/ontology/") for url in urls)


def test_after_a_first_import_everything_leads_to_the_commands(world, adam, tiny):
    page = report_of(adam, send(adam, uploads(tiny))).content.decode()
    generate = 'action="/w/home/generate/"'
    assert page.count(generate) == 1
    assert page.partition("<main")[2].partition("</main")[0].count("primary") == 1
    overview = adam.get("/w/home/")
    assert not [
        task
        for group in overview.context["work_groups"]
        for task in group.items
        if "uncovered" in task.url
    ]
    assert "coverage-bar" not in overview.content.decode()
    assert overview.content.decode().count(generate) == 1
    coverage = adam.get("/w/home/coverage/").content.decode()
    assert generate in coverage and "/w/home/templates/new/" not in coverage
    commands = adam.get("/w/home/commands/").content.decode()
    for each in (page, overview.content.decode(), coverage, commands):
        assert "<strong>3 commands</strong> wait to be generated" in each
        assert "All 3 commands of the grammar will have a form then." in " ".join(each.split())
        assert "out of date" not in each and "older than" not in each
    adam.post("/w/home/generate/")
    assert world.commands.count() == 3
    for address in ("/w/home/", "/w/home/coverage/"):
        page = adam.get(address).content.decode()
        assert generate not in page and "coverage-bar" in page


def test_an_import_without_templates_leads_to_writing_one(world, adam, tiny):
    del tiny["tiny_category_1_semantics.txt"]
    page = report_of(adam, send(adam, uploads(tiny))).content.decode()
    assert "/w/home/templates/new/" in page and "/w/home/generate/" not in page


def test_the_first_sentence_says_what_to_bring_and_what_becomes_of_it(world, adam, tiny):
    for _ in range(2):
        page = adam.get("/w/home/import/").content.decode().partition("<main")[2]
        sentence = "Bring the files of your command generator"
        assert (
            sentence in page
            and "Replaces" not in page
            and "replaced" not in page.split(sentence)[0]
        )
        assert ("would be removed" in page) is hasattr(world, "grammar")
        send(adam, uploads(tiny))
        world.refresh_from_db()


def test_everything_that_is_exported_stands_on_one_page_and_is_there(sample, adam, anna, rene):
    paraphrase_in(sample.world)
    utterance(sample)
    titles = {}
    for client in (adam, anna, rene):
        answer = client.get("/w/home/import/")
        listed = answer.context["exports"]
        titles[client] = [each.title for each in listed]
        assert ('<form class="fields"' in answer.content.decode()) is (client is adam)
        for link in (link for each in listed for link in each.links):
            given = client.get(link.url)
            assert given.status_code == 200, link.url
            assert given.has_header("Content-Disposition") is link.is_file
    assert titles[anna][:2] == ["The whole world", "Files of the generator"]
    assert {"Vocabulary", "Utterances", "Rephrased data", "Splits", "Reports"} <= {*titles[adam]}


def test_an_empty_world_offers_no_empty_file(world, anna):
    (whole,) = anna.get("/w/home/import/").context["exports"]
    assert whole.title == "The whole world"


def test_submissions_are_offered_to_whoever_may_read_them(sample, rene, anna):
    campaign_row(sample)
    submission(sample)
    assert "Submissions to campaigns" in titles_of(rene)
    assert "Submissions to campaigns" not in titles_of(anna)


def titles_of(client):
    return [each.title for each in client.get("/w/home/import/").context["exports"]]
