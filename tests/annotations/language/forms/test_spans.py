"""Where the subterms of a form are in its text."""

from __future__ import annotations

from hypothesis import given

from annotations.language.forms import Application, read_form, read_spans, to_template, walk
from tests.annotations.language.random_forms import forms


@given(forms())
def test_spans_are_in_the_order_of_the_terms_and_write_them(form):
    text = to_template(form)
    spans, terms = list(read_spans(text).walk()), list(walk(read_form(text)))
    assert len(spans) == len(terms)
    for span, term in zip(spans, terms, strict=True):
        assert text[span.start : span.end] == to_template(term)
        if isinstance(term, Application):
            assert text[span.name_start : span.name_end] == str(term.predicate)
