"""What the language of a world costs whoever reads it."""

from __future__ import annotations

from parser_service.serving.preparing import WorldLanguage


def test_plans_and_robots_need_no_derivation_of_the_grammar(sample):
    language = WorldLanguage.of(sample.world)
    assert language.recipes and language.lookup
    assert "derivations" not in vars(language.learned)
    assert language.evidence and language.learned.derivations
