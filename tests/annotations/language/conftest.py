"""Property tests of the language core: enough examples, and no deadline on a busy machine."""

from hypothesis import settings

settings.register_profile("language", deadline=None, max_examples=60)
settings.load_profile("language")
