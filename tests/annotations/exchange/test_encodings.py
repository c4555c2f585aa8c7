"""An import reads files that are not UTF-8 where somebody says what they are: by page, REST and command."""

from __future__ import annotations

import io
import json
import zipfile

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.core.management import CommandError, call_command

from annotations.models import Job, JobKind, Production, Split, World

RULES = "$Main = bring the café crème to {name}\n"
PAIRS = 'bring the café crème\n( bring " café crème " )\n'


def packed(files):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for path, content in files.items():
            archive.writestr(path, content)
    return SimpleUploadedFile("all.zip", data.getvalue())


def send(client, way, part, **values):
    address = f"import/{part}"
    base = "/w/home/" if way == "page" else "/api/v1/worlds/home/"
    return client.post(base + address, values, follow=True)


def is_refused(answer, way):
    """A page leads to that of the job, which stays; REST answers at once."""
    return answer.context["is_refused"] if way == "page" else answer.status_code == 422


@pytest.mark.parametrize("encoding", ["windows-1252", "utf-16"])
@pytest.mark.parametrize("way", ["page", "rest"])
class TestUploads:
    def test_files_of_a_generator(self, world, adam, way, encoding):
        def files():
            return [SimpleUploadedFile("a.txt", RULES.encode(encoding))]

        refused = send(adam, way, "", files=files())
        assert is_refused(refused, way)
        text = refused.content.decode()
        assert f" {encoding} " in text and "“$Main = bring the café crème" in text
        assert not Production.objects.exists()
        answer = send(adam, way, "", files=files(), encoding=encoding)
        assert answer.status_code == 200
        assert "café crème" in Production.objects.get().expansion

    def test_files_beside_those_that_the_world_has(self, world, adam, way, encoding):
        send(adam, way, "", files=[SimpleUploadedFile("a.txt", b"$Main = go\n")])
        files = [SimpleUploadedFile("b.txt", RULES.encode(encoding))]
        answer = send(adam, way, "", files=files, encoding=encoding, keeps_others="on")
        assert answer.status_code == 200
        assert Production.objects.count() == 2

    def test_pairs(self, world, adam, way, encoding):
        archive = {"gen/train.txt": PAIRS.encode(encoding)}
        refused = send(adam, way, "pairs/", name="p", archive=packed(archive))
        assert is_refused(refused, way)
        answer = send(adam, way, "pairs/", name="p", archive=packed(archive), encoding=encoding)
        assert answer.status_code == 200
        assert Split.objects.get().examples.get().utterance == "bring the café crème"


def test_a_job_remembers_what_was_chosen(world, adam, monkeypatch):
    monkeypatch.setattr("annotations.exchange.import_jobs.MOST_BYTES", 1)
    files = [SimpleUploadedFile("a.txt", RULES.encode("cp1252"))]
    send(adam, "page", "", files=files, encoding="windows-1252")
    job = Job.objects.get()
    assert job.arguments["encoding"] == "windows-1252"
    assert job.kind == JobKind.IMPORT_GENERATOR


def test_no_other_encoding_can_be_chosen(world, adam):
    files = [SimpleUploadedFile("a.txt", RULES.encode())]
    assert send(adam, "rest", "", files=files, encoding="rot13").status_code == 400


def test_the_commands_take_it_too(db, tmp_path, capsys):
    (tmp_path / "a.txt").write_bytes(RULES.encode("utf-16"))
    with pytest.raises(CommandError, match="utf-16"):
        call_command("import_generator", tmp_path, "--world", "theirs")
    capsys.readouterr()
    call_command(
        "import_generator", tmp_path, "--world", "theirs", "--encoding", "utf-16", "--json"
    )
    report = json.loads(capsys.readouterr().out)
    assert [each["severity"] for each in report["problems"]] == ["warning"]
    folder = tmp_path / "pairs" / "gen"
    folder.mkdir(parents=True)
    (folder / "dev.txt").write_bytes(PAIRS.encode("cp1252"))
    call_command(
        *(
            "import_pairs",
            folder.parent,
            "--world",
            "theirs",
            "--name",
            "p",
            "--encoding",
            "windows-1252",
        )
    )
    assert World.objects.get(name="theirs").splits.get().examples.count() == 1
