"""Put one constant of a form in place of another."""

from __future__ import annotations

from dataclasses import replace

from annotations.language.forms import Application, Constant, Form, Lambda


def substitute(form: Form, old: Constant, new: Constant) -> Form:
    """Return the form with ``new`` wherever it has ``old``."""
    if form == old:
        return new
    if isinstance(form, Lambda):
        return replace(form, bodies=tuple(substitute(body, old, new) for body in form.bodies))
    if isinstance(form, Application):
        arguments = tuple(substitute(each, old, new) for each in form.arguments)
        return replace(form, arguments=arguments)
    return form
