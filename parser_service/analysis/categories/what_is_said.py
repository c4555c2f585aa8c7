"""Compare a label with the entities that its utterance names."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from functools import lru_cache

from annotations.language.forms import Application, Constant, Form, Lambda, walk

# Their entities are whole sentences, which an utterance need not contain.
SENTENCES = frozenset({"question", "whattosay"})


@lru_cache(maxsize=1 << 14)
def classes_in(form: Form) -> tuple[str, ...]:
    """Return the class of each place that a form has for an entity which utterances name, sorted."""
    tokens = (node.token_class for node in walk(form) if isinstance(node, Constant))
    return tuple(sorted(token for token in tokens if token and token not in SENTENCES))


def unsaid_in_label(gold: Form, predicted: Form, named: Collection[str]) -> frozenset[str]:
    """Return the classes that the label alone has and the utterance does not name.

    Empty where the answer has such a class too: then names may have been overlooked in the utterance.
    """
    if not set(classes_in(predicted)) <= set(named):
        return frozenset()
    return frozenset(classes_in(gold)) - set(named)


def left_out_of_label(gold: Form, predicted: Form, named: Collection[str]) -> frozenset[str]:
    """Return the classes that the utterance names and the answer has, but not the label."""
    return frozenset(classes_in(predicted)) & set(named) - set(classes_in(gold))


def without_classes(form: Form, classes: Collection[str]) -> Form:
    """Return the form without the constraints about one of the classes; a λ keeps one body at least."""
    if isinstance(form, Application):
        arguments = tuple(without_classes(each, classes) for each in form.arguments)
        return replace(form, arguments=arguments)
    if not isinstance(form, Lambda):
        return form
    bodies = tuple(without_classes(each, classes) for each in form.bodies)
    kept = tuple(each for each in bodies if not is_about(each, classes))
    return replace(form, bodies=kept or bodies)


def is_about(form: Form, classes: Collection[str]) -> bool:
    """Tell whether a constraint has a place for an entity of one of the classes."""
    return isinstance(form, Application) and any(
        isinstance(each, Constant) and each.token_class in classes for each in form.arguments
    )
