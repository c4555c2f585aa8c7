"""λ-corpora of others: what can be read becomes a split, the rest is counted by its reason."""

from __future__ import annotations

import io
import json
import zipfile

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.core.management import CommandError, call_command

from annotations.exchange.pair_import import import_pairs
from annotations.exchange.split_export import export_split
from annotations.models import Split, World

TRAIN = (
    "ships to oslo\t( lambda $0 e ( and ( ship $0 ) ( to $0 oslo:ci ) ) )\n"
    "how many lakes\t( count $0 ( lake:t $0 ) )\n"
    "show me\t( call SW.listValue ( string x ) )\n"
    "and again\t( call SW.listValue )\n"
    "open\t( a $0 )\n"
)
DEV = (
    "// by hand\n\nwhich lake is deepest\n(argmax $0 (lake:t $0) (depth:i $0))\n\n\n"
    "no form\nships\n(lambda $0 e (ship $0))\n"
)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "train.tsv").write_text(TRAIN)
    (tmp_path / "Dev.txt").write_text(DEV)
    (tmp_path / "README.txt").write_text("what this is\n")
    return tmp_path


def rows(split):
    return [
        (each.part, each.source, each.utterance, each.logical_form)
        for each in split.examples.order_by("part", "position")
    ]


EXPECTED = [
    (
        "train",
        "paraphrased",
        "ships to oslo",
        '( lambda $1 e ( and ( ship $1 ) ( to $1 " oslo:ci " ) ) )',
    ),
    ("train", "paraphrased", "how many lakes", "( count ( lambda $1 e ( lake $1 ) ) )"),
    (
        "validation",
        "paraphrased",
        "which lake is deepest",
        "( argmax ( lambda $1 e ( lake $1 ) ) ( lambda $1 e ( depth $1 ) ) )",
    ),
    ("validation", "paraphrased", "ships", "( lambda $1 e ( ship $1 ) )"),
]


def test_what_can_be_read_becomes_a_split(db, folder):
    report = import_pairs("lakes", "theirs", folder, notation="lambda")
    assert report.errors == ()
    assert rows(Split.objects.get(name="theirs-command")) == EXPECTED
    warned = {(each.position.source, each.position.line) for each in report.problems}
    assert warned == {("train.tsv", 3), ("train.tsv", 5), ("Dev.txt", 7)}
    (calls,) = (each for each in report.problems if each.position.line == 3)
    assert "2 of 5" in calls.message and calls.position.column == 9


def test_an_export_is_in_our_notation_and_imports_as_the_same(db, folder, tmp_path):
    import_pairs("lakes", "theirs", folder, notation="lambda")
    export_split(Split.objects.get(), "txt", tmp_path / "out")
    report = import_pairs("again", "theirs", tmp_path / "out")
    assert report.problems == ()
    assert rows(Split.objects.get(world__name="again")) == EXPECTED


def test_a_file_of_which_nothing_can_be_read_refuses_the_import(db, folder):
    (folder / "test.txt").write_text("a\t( call x )\n")
    report = import_pairs("lakes", "theirs", folder, notation="lambda")
    assert [each.position.source for each in report.errors] == ["test.txt"]
    assert not Split.objects.exists()


def test_two_files_of_one_part_are_an_error(db, folder):
    (folder / "valid.txt").write_text(DEV)
    (problem,) = import_pairs("lakes", "theirs", folder, notation="lambda").errors
    assert "Dev.txt" in problem.message and problem.position.source == "valid.txt"


def test_a_folder_with_none_of_them_says_so(db, tmp_path):
    assert import_pairs("lakes", "theirs", tmp_path, notation="lambda").is_refused


@pytest.mark.parametrize("way", ["page", "rest"])
def test_by_page_and_rest(world, adam, folder, way):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for path in folder.iterdir():
            archive.write(path, f"corpus/{path.name}")
    address = "/w/home/import/pairs/" if way == "page" else "/api/v1/worlds/home/import/pairs/"
    sent = SimpleUploadedFile("corpus.zip", data.getvalue())
    values = {"name": "theirs", "archive": sent, "notation": "lambda"}
    answer = adam.post(address, values, follow=True)
    assert answer.status_code == 200
    assert "2 of 5 pairs" in answer.content.decode()
    assert rows(Split.objects.get()) == EXPECTED


def test_by_command(db, folder, capsys):
    call_command(
        "import_pairs",
        folder,
        "--world",
        "lakes",
        "--name",
        "theirs",
        "--notation",
        "lambda",
        "--json",
    )
    report = json.loads(capsys.readouterr().out)
    assert {each["severity"] for each in report["problems"]} == {"warning"}
    assert World.objects.get(name="lakes").splits.count() == 1
    with pytest.raises(CommandError):
        call_command("import_pairs", folder, "--world", "lakes", "--name", "x")
