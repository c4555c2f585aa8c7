from __future__ import annotations

import pytest

from annotations.generation.split_statistics import store_figures
from annotations.models import ApiToken, Example, Split


@pytest.fixture
def caller(client):
    """A function: the status and response of a GET with a fresh token of ``user`` (None: without)."""

    def get(url, user=None, **headers):
        if user is not None:
            _, key = ApiToken.issue(user, "notebook")
            headers["authorization"] = f"Bearer {key}"
        return client.get(url, headers=headers)

    return get


def make_split(world, name="walker-command"):
    split = Split.objects.create(world=world, name=name, criterion="command", content_hash="0" * 64)
    rows = [
        ("train", 0, "go to the <room>", '( go " <room> " )'),
        ("train", 1, "=HYPERLINK the <room>", '( go " <room> " )'),
        ("test", 0, "find the <object>", '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'),
    ]
    Example.objects.bulk_create(
        Example(
            split=split,
            part=part,
            source="generated",
            position=position,
            utterance=utterance,
            logical_form=form,
        )
        for part, position, utterance, form in rows
    )
    store_figures(split)
    return split


@pytest.fixture
def split(world):
    return make_split(world)


@pytest.fixture
def split_elsewhere(other_world):
    return make_split(other_world)
