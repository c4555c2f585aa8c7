"""Rename an entity, a nonterminal or a predicate wherever its world names it."""
