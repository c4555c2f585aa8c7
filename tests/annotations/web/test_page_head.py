"""The head that every page has: title, sentence, actions in one place."""

from __future__ import annotations

import pytest
from django.template import engines

SOURCE = """{% load presentation %}{% page_head title=title aside="run 3" %}
  {% actions %}{% include "_mark.html" %}{% end_actions %}
  About {{ name }}, <a href="#x">here</a>.
{% end_page_head %}"""


@pytest.fixture
def head() -> str:
    template = engines["django"].from_string(SOURCE)
    return template.render({"title": "Runs <1>", "name": "<b>"})


def test_it_shows_title_sentence_and_actions(head):
    assert '<h1>Runs &lt;1&gt; <span class="count">run 3</span></h1>' in head
    assert '<p>About &lt;b&gt;, <a href="#x">here</a>.</p>' in head
    assert '<div class="actions"><svg' in head


def test_what_is_not_given_leaves_no_trace():
    template = engines["django"].from_string('{% include "_page_head.html" with title="Runs" %}')
    head = template.render({})
    assert "<p>" not in head and "actions" not in head
