"""Requests that wait for one parser are answered together."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from parser_service.parsers.interface import Candidate
from parser_service.serving.batching import MOST_TOGETHER, Batcher
from tests.waiting import wait_for


class Echo:
    """Answers each text with itself and the beam; the first call waits until it is let go."""

    def __init__(self) -> None:
        self.calls: list[list[str]] = []
        self.go_on = threading.Event()

    def predict(self, texts, beam):
        self.calls.append(list(texts))
        if len(self.calls) == 1:
            self.go_on.wait(60)
        if "bad" in texts:
            raise ValueError("bad is not said")
        return [[Candidate(text, beam)] for text in texts]


@pytest.fixture
def echo():
    return Echo()


@pytest.fixture
def ask_while_busy(echo):
    """Returns a function that asks all at once while the parser answers something else."""

    def ask(*requests: tuple[list[str], int]) -> list[object]:
        batcher = Batcher(echo.predict, threading.Lock())
        with ThreadPoolExecutor(len(requests) + 1) as threads:
            first = threads.submit(batcher.ask, ["first"], 1)
            wait_for(lambda: bool(echo.calls), "the first call")
            asked = [threads.submit(batcher.ask, *request) for request in requests]
            wait_for(lambda: len(batcher._waiting) == len(requests), "all wait")
            echo.go_on.set()
            first.result()
        return [each.exception() or each.result() for each in asked]

    return ask


def test_those_that_wait_are_answered_in_one_call(echo, ask_while_busy):
    answers = ask_while_busy((["a"], 5), (["b", "c"], 5), (["d"], 5))
    assert len(echo.calls) == 2
    assert [[each[0].form for each in answer] for answer in answers] == [["a"], ["b", "c"], ["d"]]


def test_another_beam_is_another_call(echo, ask_while_busy):
    answers = ask_while_busy((["a"], 5), (["b"], 2))
    assert len(echo.calls) == 3
    assert [answer[0][0].score for answer in answers] == [5, 2]


def test_a_call_has_a_largest_size(echo, ask_while_busy):
    many = [f"text {number}" for number in range(MOST_TOGETHER)]
    ask_while_busy((many, 5), (["a"], 5))
    assert sorted(map(len, echo.calls)) == [1, 1, MOST_TOGETHER]


def test_an_utterance_that_a_parser_refuses_harms_no_other(ask_while_busy):
    good, bad = ask_while_busy((["a"], 5), (["bad"], 5))
    assert good[0][0].form == "a"
    assert str(bad) == "bad is not said"
