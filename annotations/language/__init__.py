"""The language core: grammar, semantic templates, logical forms and the world they talk about.

Pure Python: no Django and no torch. Frozen values go in and frozen values come out.
"""
