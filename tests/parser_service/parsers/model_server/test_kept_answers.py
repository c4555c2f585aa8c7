"""Answers that came are kept: for the same question alone, bounded, and for several processes."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import pytest

from parser_service.parsers.model_server.kept_answers import FOLDERS, KeptAnswers
from parser_service.parsers.model_server.protocol import ModelAnswer, Question

QUESTION = Question("tiny", ({"role": "user", "content": "hello"},), {"enum": ["a"]}, 0, 100)
ANSWER = ModelAnswer('{"form": "ä"}', "tiny-2026")


def files(folder):
    return [path for path in folder.rglob("*") if path.is_file()]


def test_an_answer_is_found_by_its_question_alone(tmp_path):
    answers = KeptAnswers(tmp_path / "llm")
    assert answers.find(QUESTION) is None
    answers.keep(QUESTION, ANSWER)
    assert KeptAnswers(tmp_path / "llm").find(replace(QUESTION)) == ANSWER
    for change in (
        {"model": "large"},
        {"messages": ({"role": "user", "content": "hello!"},)},
        {"schema": {"enum": ["a", "b"]}},
        {"schema": None},
        {"seed": 1},
        {"max_tokens": 101},
    ):
        assert answers.find(replace(QUESTION, **change)) is None


def test_neither_the_question_nor_anything_for_others_is_on_the_disk(tmp_path):
    KeptAnswers(tmp_path / "llm").keep(QUESTION, ANSWER)
    [path] = files(tmp_path)
    assert "hello" not in path.read_text()
    assert path.parent.stat().st_mode & 0o077 == 0


@pytest.mark.parametrize("text", ["", "{", "[]", '{"text": 1}', "\udcff"])
def test_a_spoilt_file_is_as_good_as_none(tmp_path, text):
    answers = KeptAnswers(tmp_path)
    answers.keep(QUESTION, ANSWER)
    files(tmp_path)[0].write_text(text, encoding="utf-8", errors="surrogateescape")
    assert answers.find(QUESTION) is None
    answers.keep(QUESTION, ANSWER)
    assert answers.find(QUESTION) == ANSWER


def test_the_longest_unread_make_room(tmp_path):
    answers = KeptAnswers(tmp_path, most=2 * FOLDERS)
    questions = [replace(QUESTION, seed=seed) for seed in range(3_000)]
    for question in questions:
        answers.keep(question, ANSWER)
    assert len(files(tmp_path)) <= 2 * FOLDERS
    assert answers.find(questions[-1]) == ANSWER


def test_a_disk_that_cannot_be_written_keeps_nothing_and_fails_nobody(tmp_path):
    (tmp_path / "llm").write_text("a file where the folder should be")
    answers = KeptAnswers(tmp_path / "llm")
    answers.keep(QUESTION, ANSWER)
    assert answers.find(QUESTION) is None
    KeptAnswers(None).keep(QUESTION, ANSWER)
    assert KeptAnswers(None).find(QUESTION) is None


def test_two_processes_keep_and_make_room_in_one_folder(tmp_path):
    code = (
        "import sys; from pathlib import Path; from dataclasses import replace\n"
        "from tests.parser_service.parsers.model_server.test_kept_answers import *\n"
        "answers = KeptAnswers(Path(sys.argv[1]), most=FOLDERS)\n"
        "for seed in range(400):\n"
        "    question = replace(QUESTION, seed=seed)\n"
        "    answers.keep(question, replace(ANSWER, text=str(seed) * 2_000))\n"
        "    found = answers.find(question)\n"
        "    assert found is None or found.text == str(seed) * 2_000, found\n"
    )
    run = [sys.executable, "-c", code, str(tmp_path)]
    both = [subprocess.Popen(run, stderr=subprocess.PIPE, text=True) for _ in range(2)]
    told = [each.communicate(timeout=120)[1] for each in both]
    assert [each.returncode for each in both] == [0, 0], told
    assert [path for path in files(tmp_path) if path.name.startswith(".")] == []
    assert len(files(tmp_path)) <= FOLDERS
