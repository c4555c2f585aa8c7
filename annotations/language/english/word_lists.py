"""The word lists as values; ``data/*.toml`` holds the words and says what each list is for."""

from __future__ import annotations

from functools import cache

from annotations.language.english.reading import WordFile

_words = WordFile("words")
ARTICLES = frozenset(_words.words("articles"))
DETERMINERS = frozenset(_words.words("determiners"))
NEGATIONS = frozenset(_words.words("negations"))
BOUNDARIES = frozenset(_words.words("boundaries"))
PLACE_PREPOSITIONS = frozenset(_words.words("place_prepositions"))
CHOOSING_WORDS = frozenset(_words.words("choosing"))
CHOICE_FILLERS = frozenset(_words.words("choice_fillers"))
VAGUE_WORDS = frozenset(_words.words("vague"))
GOING_WORDS = frozenset(_words.words("going"))
POLITE_OPENINGS = _words.words("polite_openings")
NO_COMMAND_WORDS = frozenset(_words.words("no_command"))

_nouns = WordFile("nouns")
NUMBERS = _nouns.words("numbers")
PERSON_WORDS = frozenset(_nouns.words("persons"))
THING_WORDS = frozenset(_nouns.words("things"))
RECIPIENT_PRONOUNS = _nouns.words("recipients")
ANY_OBJECT = _nouns.text("any_object")
OPEN_CATEGORIES = _nouns.words("open_categories")
PLURALS = _nouns.texts_by_name("plurals")
CLASS_WORDS = _nouns.texts_by_name("classes")
OBFUSCATED = _nouns.texts_by_name("obfuscated")
PRONOUNS = _nouns.tables_by_name("pronouns")

_answers = WordFile("answers")
YES_WORDS = frozenset(_answers.words("yes"))
NO_WORDS = frozenset(_answers.words("no"))
STOP_WORDS = frozenset(_answers.words("stop"))
ANSWER_OPENINGS = frozenset(_answers.words("openings"))
IS_NEW = _answers.expression("new")
IS_EITHER = _answers.expression("either")

_glosses = WordFile("glosses")
RELATIONS = frozenset(_glosses.words("relations"))
PREPOSITIONS = _glosses.texts_by_name("prepositions")
KNOWN_PATTERNS = _glosses.texts_by_name("predicates")

_contrasts = WordFile("contrasts")
PREDICATE_WORDS = _contrasts.words_by_name("words")
CONTRASTS = _contrasts.groups("contrasts")
NEAR_SYNONYMS = _contrasts.groups("near_synonyms")

_arguments = WordFile("arguments")
ARGUMENT_NAMES = _arguments.choices_by_name("names")
NEEDED_ARGUMENTS = _arguments.words_by_name("needed")
ARGUMENT_QUESTIONS = _arguments.texts_by_name("questions")


@cache
def sample_commands() -> tuple[tuple[str, str], ...]:
    """Return commands with their forms, both with numbered class tokens."""
    groups = WordFile("sample_commands").tables("commands")
    return tuple((text, group["form"]) for group in groups for text in group["texts"])


@cache
def unrelated_sentences() -> tuple[str, ...]:
    """Return sentences that are no command."""
    return WordFile("unrelated_sentences").words("sentences")
