"""Renames an entity, a nonterminal or a predicate wherever its world names it."""

from annotations.renaming.rename_plans import PLANS
from annotations.renaming.renaming import Touched, rename, touched_by

__all__ = [
    "PLANS",
    "Touched",
    "rename",
    "touched_by",
]
