"""Word lists are files that a team can replace."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from annotations.language.forms import read_form
from annotations.language.texts import EnglishError, sample_commands, word_lists

DATA = Path(word_lists.__file__).parent / "data"
ASK = (
    "from annotations.language.plans import reaction_of; "
    "print(reaction_of('aye aye'), reaction_of('no'))"
)


def say(folder: Path) -> subprocess.CompletedProcess[str]:
    """The reaction to "aye aye" and to "no" with the lists of a folder."""
    environment = {**os.environ, word_lists.VARIABLE: str(folder)}
    return subprocess.run(
        [sys.executable, "-c", ASK], env=environment, capture_output=True, text=True, check=False
    )


def test_a_team_s_file_replaces_one_file_and_leaves_the_others(tmp_path):
    lists = (DATA / "answers.toml").read_text(encoding="utf-8")
    (tmp_path / "answers.toml").write_text(lists.replace('"yes", ', '"yes", "aye", '), "utf-8")
    assert say(tmp_path).stdout.split() == ["yes", "no"]
    assert say(tmp_path / "nothing").stdout.split() == ["other", "no"]


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ('yes = ["aye"]', "“no”"),
        ("yes = [", "TOML"),
        ('yes = "aye"', "“yes”, 'aye' .* list "),
        ("yes = [1]", "“yes”, 1 .* text "),
    ],
)
def test_a_file_that_cannot_be_used_is_refused_with_what_is_wrong(
    tmp_path, monkeypatch, text, named
):
    (tmp_path / "answers.toml").write_text(text, encoding="utf-8")
    monkeypatch.setenv(word_lists.VARIABLE, str(tmp_path))
    with pytest.raises(EnglishError, match=rf"answers\.toml.*{named}"):
        lists = word_lists.WordFile("answers")
        lists.words("yes")
        lists.words("no")


def test_every_sample_has_the_slots_of_its_form():
    for text, form in sample_commands():
        tokens = {word for word in text.split() if word.startswith("<")}
        assert tokens and all(f'"{token}"' in form for token in tokens)
        read_form(form)
