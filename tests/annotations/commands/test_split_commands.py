"""manage.py import_pairs, freeze_split and export_split, each with --json"""

from __future__ import annotations

import pytest

from annotations.generation.generating import generate_pairs
from annotations.models import Split
from tests.annotations.commands.run_command import run
from tests.annotations.rows_of import counts


@pytest.fixture
def generated(tiny_world):
    generate_pairs(tiny_world)
    return tiny_world


def test_published_pairs_are_counted_by_criterion_source_and_part(db, shared_data):
    arguments = [shared_data / "walker2019", "--world", "walker", "--name", "published"]
    report, failure = run("import_pairs", *arguments)
    assert failure is None
    assert report["counts"] == {
        "command": {
            "generated": {"train": 847, "validation": 121},
            "paraphrased": {"train": 1265, "validation": 181},
        },
        "logical_form": {
            "generated": {"train": 850, "validation": 129},
            "paraphrased": {"train": 1244, "validation": 211},
        },
    }
    assert report["splits"]["logical_form"] == "published-logical_form"
    assert report["paraphrases"] == 1300


def test_an_odd_number_of_lines_is_refused_at_the_last(generated, tmp_path):
    (tmp_path / "gen").mkdir()
    (tmp_path / "gen" / "train.txt").write_text('go\n( go " <room> " )\ncome\n')
    before = counts()
    report, failure = run("import_pairs", tmp_path, "--world", "home", "--name", "odd")
    (problem,) = report["problems"]
    assert (problem["file"], problem["line"]) == ("gen/train.txt", 3)
    assert failure.returncode == 1
    assert counts() == before


def test_one_criterion_takes_the_name_as_it_is(generated):
    report, _ = run("freeze_split", "home", "--name", "first", "--seed", 3)
    (split,) = report["splits"]
    assert (split["name"], split["criterion"], split["seed"]) == ("first", "command", 3)
    assert sum(split["counts"]["generated"][part] for part in ("train", "validation", "test")) == 3


def test_several_criteria_take_the_name_each_with_its_own(generated):
    criteria = "command,source_command,logical_form"
    report, _ = run("freeze_split", "home", "--name", "first", "--criterion", criteria)
    assert [each["name"] for each in report["splits"]] == [
        "first-command",
        "first-source_command",
        "first-logical_form",
    ]


def test_freezing_is_all_or_nothing(generated):
    run("freeze_split", "home", "--name", "first-logical_form", "--seed", 9)
    _, failure = run(
        "freeze_split", "home", "--name", "first", "--criterion", "command,logical_form"
    )
    assert "first-logical_form" in str(failure) and failure.returncode == 1
    assert list(Split.objects.values_list("name", flat=True)) == ["first-logical_form"]


@pytest.mark.parametrize(
    ("option", "value", "named"),
    [
        ("--criterion", "length", "“length”"),
        ("--parts", "70,10", " 2 "),
        ("--parts", "70,10,10", "90 %"),
        ("--parts", "most", "most"),
        ("--name", "a b", "“a b"),
    ],
)
def test_a_wrong_option_is_answered_with_what_is_wrong(generated, option, value, named):
    report, failure = run("freeze_split", "home", "--name", "first", option, value)
    assert report is None and failure.returncode == 1
    assert named in str(failure) and not Split.objects.exists()


def test_a_split_is_exported_by_its_short_name(generated, tmp_path):
    run("freeze_split", "home", "--name", "first", "--criterion", "command,logical_form")
    report, _ = run("export_split", "home", "first", "--output", tmp_path / "out")
    assert report["split"] == "first-command"
    assert sum(report["files"].values()) == 3
    assert all((tmp_path / path).is_file() for path in report["files"])


def test_a_split_that_is_not_there_is_answered_with_those_that_are(generated, tmp_path):
    run("freeze_split", "home", "--name", "first")
    _, failure = run("export_split", "home", "second", "--output", tmp_path)
    assert "“second”" in str(failure) and ": first." in str(failure)


def test_the_leakage_of_a_split_is_reported_by_part(db, shared_data):
    run("import_pairs", shared_data / "walker2019", "--world", "walker", "--name", "published")
    report, failure = run("leakage", "walker", "published", "--examples", 2)
    assert failure is None
    rows = {(row["part"], row["what"]): row for row in report["shared"]}
    assert set(rows) >= {
        ("validation", what)
        for what in ("utterances", "source commands", "logical forms", "near duplicates")
    }
    assert rows["validation", "utterances"]["pairs"] == 121 + 181
    assert rows["validation", "near duplicates"]["shared"] > 0
    listed = report["near_duplicates"]["validation"]
    assert len(listed) == 2
    assert all(each["similarity"] >= 0.9 for each in listed)


def test_a_split_that_is_not_there_has_no_leakage(generated):
    _, failure = run("leakage", "home", "nowhere")
    assert "“nowhere”" in str(failure) and failure.returncode == 1
