"""manage.py generate_pairs NAME --json"""

from __future__ import annotations

from annotations.language.corpus import read_pairs
from tests.annotations.commands.run_command import run


def test_the_report_has_the_documented_keys(tiny_world):
    report, failure = run("generate_pairs", "home")
    assert failure is None
    assert report["commands"] == {"1": 3, "all": 3}
    assert report["forms"] == {"1": 2, "all": 2}
    assert (report["conflicts"], report["outside_grammar"]) == ([], 0)
    assert report["mean_command_length"] == {"1": 3.3333, "all": 3.3333}


def test_a_conflict_names_both_templates(tiny_world):
    tiny_world.grammar.templates.create(
        source="tiny_category_1_semantics.txt",
        pattern="go to the {room}",
        form="(visit {room})",
        line=9,
        position=9,
    )
    (conflict,) = run("generate_pairs", "home")[0]["conflicts"]
    assert conflict == {
        "task_category": "1",
        "command": "go to the <room>",
        "kept": '( visit " <room> " )',
        "candidates": [
            {"template": "tiny_category_1_semantics.txt:3:1", "form": '( go " <room> " )'},
            {"template": "tiny_category_1_semantics.txt:9:1", "form": '( visit " <room> " )'},
        ],
    }


def test_the_output_is_a_pair_file_sorted_by_length(tiny_world, tmp_path):
    report, _ = run("generate_pairs", "home", "--output", tmp_path / "pairs.txt")
    written = read_pairs((tmp_path / "pairs.txt").read_bytes(), "pairs.txt")
    commands = [each.utterance for each in written.records]
    assert not written.problems
    assert sorted(commands) == ["find the <object>", "go to the <room>", "locate the <object>"]
    assert [len(each) for each in commands] == sorted(len(each) for each in commands)
    assert report["output"]["pairs"] == 3


def test_grounded_pairs_are_written_under_a_seed(tiny_world, tmp_path):
    for name in ("one.txt", "two.txt"):
        options = ["--output", tmp_path / name, "--grounded", 25, "--seed", 4]
        report, _ = run("generate_pairs", "home", *options)
    assert report["output"]["pairs"] == 25
    assert (tmp_path / "one.txt").read_bytes() == (tmp_path / "two.txt").read_bytes()
    assert "find the tea" in (tmp_path / "one.txt").read_text()


def test_grounded_pairs_need_a_file(tiny_world):
    report, failure = run("generate_pairs", "home", "--grounded", 25)
    assert report is None
    assert "--output" in str(failure)


def test_a_file_that_cannot_be_written_is_a_sentence(tiny_world, tmp_path):
    _, failure = run("generate_pairs", "home", "--output", tmp_path / "nowhere" / "pairs.txt")
    assert "nowhere" in str(failure) and failure.returncode == 1


def test_more_than_the_limit_is_refused_with_the_number(tiny_world):
    report, failure = run("generate_pairs", "home", "--limit", 2)
    assert report is None
    assert "up to 3 commands" in str(failure)
    assert not tiny_world.commands.exists()


def test_a_sample_is_drawn_under_a_seed_and_remembered(tiny_world):
    report, _ = run("generate_pairs", "home", "--sample", 2, "--seed", 4, "--balanced", "forms")
    assert report["commands"]["all"] == 2
    assert report["sample"] == {
        **{"commands": 2, "of": "3", "is_all": False},
        **{"size": 2, "seed": 4, "balanced": "forms"},
    }
    assert run("generate_pairs", "home")[0]["sample"] == report["sample"]
    report, _ = run("generate_pairs", "home", "--sample", 0)
    assert (report["commands"]["all"], report["sample"]) == (3, None)


def test_balance_needs_a_sample(tiny_world):
    for options in (["--balanced", "lines"], ["--sample", -1], ["--sample", 2, "--seed", -1]):
        report, failure = run("generate_pairs", "home", *options)
        assert report is None
        assert failure is not None
