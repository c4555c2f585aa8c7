from __future__ import annotations

from pathlib import Path

import pytest

import annotations
from annotations.exchange.generator_import import import_generator
from annotations.exchange.pair_files import gather_pairs, read_pair_folder
from annotations.exchange.pair_import import import_pairs
from annotations.exchange.split_export import export_split
from annotations.generation.generating import generate_pairs
from annotations.models import Paraphrase, Split, World
from tests.annotations.rows_of import counts

STARTER = Path(annotations.__file__).parent / "starter" / "household"
GO = '( go " <room> " )'
FIND = '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'


@pytest.fixture
def folder(tmp_path):
    """A published corpus of five pairs and two records."""
    files = {
        "gen/train.txt": f"go to the <room>\n{GO}\n",
        "gen/val.txt": f"find the <object>\n{FIND}\n",
        "para/train.txt": f"drive to the bath\n{GO}\nroll to the bath\n{GO}\n",
        "para_logical/test.txt": f"where is the tea\n{FIND}\n",
        "paraphrasings.txt": (
            'drive to the bath\ngo to the bath\n( go "  bath " )\n'
            'where is the tea\nfind the tea\n( find ( lambda $1 e ( is_a $1 " tea " ) ) )\n'
        ),
    }
    for path, text in files.items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text)
    return tmp_path


@pytest.fixture
def generated(tiny_world):
    generate_pairs(tiny_world)
    return tiny_world


def test_each_criterion_becomes_a_split(generated, folder):
    report = import_pairs("home", "walker", folder)
    assert report.counts == {
        "command": {
            "generated": {"train": 1, "validation": 1},
            "paraphrased": {"train": 2},
        },
        "logical_form": {"paraphrased": {"test": 1}},
    }
    by_command = Split.objects.named("walker")
    assert (by_command.name, by_command.seed) == ("walker-command", None)
    assert Split.objects.named("walker", "logical_form").name == "walker-logical_form"


def test_an_example_knows_the_command_behind_it(generated, folder):
    import_pairs("home", "walker", folder)
    known, unknown = Split.objects.named("walker").examples.of("train", "paraphrased")
    assert known.source_command == "go to the <room>"
    assert known.task_category == "1"
    assert known.grounded_form == '( go " bath " )'
    assert (unknown.source_command, unknown.grounded_form) == ("", "")


def test_a_paraphrase_is_linked_measured_and_anonymized(generated, folder):
    import_pairs("home", "walker", folder)
    said = Paraphrase.objects.get(utterance="drive to the bath")
    assert said.command.anonymized_text == said.prompt.replace("bath", "<room>")
    assert (said.logical_form, said.grounded_form) == (GO, '( go " bath " )')
    assert said.edit_distance == 5
    assert said.jaccard_distance == pytest.approx(0.4)


def test_a_second_import_changes_nothing(generated, folder):
    import_pairs("home", "walker", folder)
    before = counts(), list(Split.objects.values()), list(Paraphrase.objects.values())
    report = import_pairs("home", "walker", folder)
    assert (counts(), list(Split.objects.values()), list(Paraphrase.objects.values())) == before
    assert report.added == 0 and not report.is_refused


def test_a_split_that_was_imported_before_its_world_was_generated_is_the_same(tiny_world, folder):
    import_pairs("home", "walker", folder)
    generate_pairs(tiny_world)
    assert import_pairs("home", "walker", folder).added == 0


def test_other_pairs_under_a_name_that_is_taken_are_refused_whole(generated, folder):
    import_pairs("home", "walker", folder)
    before = counts()
    (folder / "gen" / "train.txt").write_text(f"visit the <room>\n{GO}\n")
    (folder / "paraphrasings.txt").write_text('see the bath\nvisit the bath\n( go " bath " )\n')
    report = import_pairs("home", "walker", folder)
    assert "walker" in report.errors[0].message and report.errors[0].hint
    assert counts() == before


@pytest.mark.parametrize(
    ("path", "data", "line", "named"),
    [
        ("gen/train.txt", b"go to the <room>\n", 1, " 2"),
        ("gen/train.txt", b"", 1, ""),
        ("gen/train.txt", "go\n( go )\n".encode("utf-16"), 1, "UTF-16"),
        ("gen/val.txt", b"go\n( go $1 )\n", 2, "$1"),
        ("gen/val.txt", b"go\n( go\n", 2, ""),
        ("para/train.txt", b"\n( go UNKNOWN )\n", 1, ""),
        ("para/train.txt", b"go\n" + b"( a " * 1_000 + b"\n", 2, " 64"),
        ("paraphrasings.txt", b"go\nto\n", 2, " 3"),
    ],
)
def test_a_faulty_file_refuses_the_whole_import(generated, folder, path, data, line, named):
    before = counts()
    (folder / path).write_bytes(data)
    report = import_pairs("home", "walker", folder)
    assert any(
        (each.position.source, each.position.line) == (path, line) and named in each.message
        for each in report.errors
    )
    assert counts() == before


def test_a_folder_without_pairs_is_refused(db, tmp_path):
    (problem,) = import_pairs("home", "walker", tmp_path).errors
    assert problem.is_error
    assert not World.objects.exists()


def test_a_file_that_is_no_part_is_a_warning(generated, folder):
    (folder / "gen" / "notes.txt").write_text("whatever")
    (problem,) = import_pairs("home", "walker", folder).problems
    assert problem.position.source == "gen/notes.txt" and not problem.is_error


def test_a_split_name_that_no_url_can_hold_is_refused(generated, folder):
    (problem,) = import_pairs("home", "a b", folder).errors
    assert "“a b" in problem.message and not Split.objects.exists()


@pytest.mark.parametrize("criterion", ["command", "logical_form"])
def test_the_published_corpus_comes_back_byte_for_byte(db, shared_data, tmp_path, criterion):
    import_pairs("walker", "published", shared_data / "walker2019")
    export_split(Split.objects.named("published", criterion), "txt", tmp_path)
    written = sorted(tmp_path.rglob("*.txt"))
    assert len(written) == 4
    for path in written:
        original = shared_data / "walker2019" / path.relative_to(tmp_path)
        assert path.read_bytes() == original.read_bytes()


def test_a_form_that_is_not_canonical_comes_back_as_it_was_written(generated, folder, tmp_path):
    text = 'pass the <object>\n(bring (λ$7:e (is_a $7 "<object>")))\n'
    (folder / "gen" / "val.txt").write_text(text)
    import_pairs("home", "walker", folder)
    split = Split.objects.named("walker")
    example = split.examples.get(part="validation")
    assert example.logical_form == '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'
    export_split(split, "txt", tmp_path / "out")
    assert (tmp_path / "out" / "gen" / "val.txt").read_text() == text


def test_most_published_prompts_find_their_command(db, shared_data):
    import_generator("gpsr2018", shared_data / "generator-2018")
    world = World.objects.get(name="gpsr2018")
    generate_pairs(world)
    import_pairs("gpsr2018", "published", shared_data / "walker2019")
    assert world.paraphrases.count() == 1300
    assert world.paraphrases.exclude(command=None).count() >= 1263


def test_every_paraphrase_of_the_starter_world_finds_its_command_and_form(db):
    import_generator("household", STARTER)
    world = World.objects.get(name="household")
    generate_pairs(world)
    assert not import_pairs("household", "first", STARTER).problems
    said = world.paraphrases.select_related("command__logical_form")
    assert said.count() >= 200
    differing = [
        (each.prompt, each.logical_form)
        for each in said
        if each.command is None or each.logical_form != each.command.logical_form.text
    ]
    assert differing == []


def test_a_file_that_is_too_large_is_refused_whole(world, folder):
    report = import_pairs("home", "published", folder, most_bytes=50)
    assert report.is_refused
    assert all(" 50 " in problem.message for problem in report.problems)
    assert not Split.objects.exists()


def test_forms_that_are_written_alike_are_kept_once(folder):
    pairs = read_pair_folder(gather_pairs(folder)).pairs["command", "paraphrased", "train"]
    assert len(pairs) == 2 and pairs[0].form is pairs[1].form
    assert pairs[0].position != pairs[1].position


@pytest.mark.parametrize("name", ["valid.txt", "dev.txt", "validation.txt", "VAL.TXT", "Dev.txt"])
def test_the_validation_part_has_several_usual_names(generated, folder, name):
    (folder / "gen" / "val.txt").rename(folder / "gen" / name)
    report = import_pairs("home", "walker", folder)
    assert not report.is_refused
    assert report.counts["command"]["generated"]["validation"]


def test_two_files_of_one_part_are_an_error_that_names_both(generated, folder):
    (folder / "gen" / "dev.txt").write_bytes((folder / "gen" / "val.txt").read_bytes())
    (problem,) = import_pairs("home", "walker", folder).errors
    assert problem.position.source == "gen/val.txt" and "gen/dev.txt" in problem.message


def test_folders_and_files_are_known_in_any_case_of_letters(generated, folder):
    expected = import_pairs("home", "plain", folder).counts
    (folder / "gen" / "train.txt").rename(folder / "gen" / "Train.TXT")
    (folder / "gen").rename(folder / "GEN")
    assert import_pairs("home", "walker", folder).counts == expected


def test_a_table_beside_the_pairs_is_left_out_with_a_warning(generated, folder):
    (folder / "Results.CSV").write_text("WorkerId,Input.command1,Answer.utterance1\nw,go,walk\n")
    report = import_pairs("home", "crowd", folder)
    assert not report.is_refused
    assert [each.position.source for each in report.problems] == ["Results.CSV"]


def test_a_folder_of_which_nothing_can_be_taken_is_refused(generated, tmp_path):
    (tmp_path / "other.csv").write_text("text,label\na,b\n")
    report = import_pairs("home", "none", tmp_path)
    assert report.is_refused and len(report.problems) == 2


def test_what_does_not_show_is_left_out_of_splits_and_paraphrases(generated, folder):
    import_pairs("home", "clean", folder)
    before = Paraphrase.objects.count()
    for path in ("gen/train.txt", "para/train.txt", "paraphrasings.txt"):
        text = (folder / path).read_text()
        (folder / path).write_text(text.replace("to the", "to\u200b the\xad"))
    report = import_pairs("home", "odd", folder)
    assert not report.is_refused and Paraphrase.objects.count() == before
    clean, odd = Split.objects.named("clean"), Split.objects.named("odd")
    assert odd.content_hash == clean.content_hash
    assert {(each.position.source, each.position.line) for each in report.problems} == {
        ("gen/train.txt", 1),
        ("para/train.txt", 1),
        ("para/train.txt", 3),
        ("paraphrasings.txt", 1),
        ("paraphrasings.txt", 2),
    }
    export_split(odd, "txt", folder / "out")
    assert "to the" in (folder / "out" / "gen" / "train.txt").read_text()
