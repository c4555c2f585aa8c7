"""The generated command behind a prompt."""

from __future__ import annotations

import pytest

from annotations.exchange.prompt_sources import SourceFinder

COMMANDS = (
    "bring me the largest <category>",
    "Pour some cereals into the bowl",
    "go to the <room>",
)


@pytest.fixture
def finder(db):
    return SourceFinder(None, COMMANDS)


@pytest.mark.parametrize(
    ("prompt", "command"),
    [
        ("go to the <room>", "go to the <room>"),
        ("bring me the largest objects", "bring me the largest <category>"),
        ("Pour some cereals into the bowl", "Pour some cereals into the bowl"),
    ],
)
def test_a_prompt_leads_to_its_command(finder, prompt, command):
    assert finder.text(prompt) == command
    assert finder.is_command(command)


def test_a_prompt_of_no_command_stands_for_itself(finder):
    assert finder.text("say something about yourself") == "say something about yourself"
    assert not finder.is_command("say something about yourself")
