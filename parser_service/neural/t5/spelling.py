"""The spelling of forms that an encoder–decoder writes: the short one, cut into atoms.

``at:$1:<room>`` of the short spelling is ``at: :$1 :<room>`` here. Atoms combine to forms that training
has never shown, and there are few of them: each becomes a token of its own, so that no tokenizer has
to know parentheses, angle brackets or the names of predicates.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from urllib.parse import unquote

from annotations.language.forms import Form, read_form
from annotations.language.texts import LanguageError
from parser_service.parsers.short import CLOSE, is_leaf_application, lengthen, name_of, shorten

INSIDE = ":"  # begins an argument of a leaf application, and ends its predicate
_WORD = re.compile(r"[^\W_]+")


def spell(form: Form) -> tuple[str, ...]:
    """Return the atoms of a form. Raises ValueError for a form with slots of a template."""
    atoms: list[str] = []
    for token in shorten(form):
        if is_leaf_application(token) and not token.startswith("("):
            name, *leaves = token.split(INSIDE)
            atoms += [name + INSIDE, *(INSIDE + leaf for leaf in leaves)]
        else:
            atoms.append(token)
    return tuple(atoms)


def try_to_spell(text: str) -> tuple[str, ...] | None:
    """Return the atoms of a form in corpus text; None for a text that is not a whole form."""
    try:
        return spell(read_form(text))
    except (LanguageError, ValueError):
        return None


def read(atoms: Sequence[str]) -> Form:
    """Return the form that ``spell`` wrote. Raises ValueError for atoms that are not a form."""
    tokens: list[str] = []
    for atom in atoms:
        if not atom.startswith(INSIDE):
            tokens.append(atom)
        elif tokens and INSIDE in tokens[-1]:
            tokens[-1] = tokens[-1].removesuffix(INSIDE) + atom
        else:
            raise ValueError(f"{' '.join(atoms)} has arguments without a predicate.")
    if any(token.endswith(INSIDE) for token in tokens):
        raise ValueError(f"{' '.join(atoms)} has a predicate without arguments.")
    return lengthen(tokens)


def words_of(atom: str) -> str:
    """Return the English words in an atom, whose vectors its own starts from: ``left of`` for
    ``left_of:``."""
    if atom == CLOSE:
        return "end"
    return " ".join(_WORD.findall(name_of(atom) or unquote(atom))) or "unknown"
