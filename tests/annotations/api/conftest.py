from __future__ import annotations

import pytest

from annotations.models import ApiToken, Example, Scope, Split


@pytest.fixture
def caller(client):
    """A function: the status and response of a GET with a fresh token of ``user`` (None: without)."""

    def get(url, user=None, **headers):
        if user is not None:
            _, key = ApiToken.issue(user, "notebook")
            headers["authorization"] = f"Bearer {key}"
        return client.get(url, headers=headers)

    return get


@pytest.fixture
def call_as(client):
    """A function: the answer to a request below ``/api/v1/`` with a fresh token of ``user``.

    ``data`` is sent as JSON, ``files`` as a form; further names are headers.
    """

    def send(user, method, path, data=None, files=None, scope=Scope.ADMIN, **headers):
        _, key = ApiToken.issue(user, "notebook", scope=scope)
        headers = {name.replace("_", "-"): value for name, value in headers.items()}
        headers["authorization"] = f"Bearer {key}"
        options = {} if files else {"content_type": "application/json"}
        address = f"/api/v1/{path}"
        return getattr(client, method)(address, files or data, headers=headers, **options)

    return send


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
    return split


@pytest.fixture
def split(world):
    return make_split(world)


@pytest.fixture
def split_elsewhere(other_world):
    return make_split(other_world)
