from parser_service.neural.seq2seq.vocabulary import END, PADDING, START, UNKNOWN, Vocabulary

SENTENCES = [["go", "to", "it"], ["go", "home"]]


def test_words_have_numbers_after_the_special_ones():
    vocabulary = Vocabulary.of(SENTENCES)
    assert vocabulary.words == ("go", "home", "it", "to")
    assert vocabulary.numbers(["go", "to", "mars"]) == [4, 7, UNKNOWN]
    assert len(vocabulary) == 8


def test_rare_words_are_unknown():
    assert Vocabulary.of(SENTENCES, minimum_count=2).words == ("go",)


def test_a_sentence_ends_at_the_first_end():
    vocabulary = Vocabulary.of(SENTENCES)
    assert vocabulary.sentence([4, 7, END, 5, PADDING]) == ["go", "to"]
    assert vocabulary.sentence([4, 7]) == ["go", "to"]


def test_a_word_that_looks_special_is_a_word_of_its_own():
    vocabulary = Vocabulary.of([["@end", "@start"]])
    assert not {START, END} & set(vocabulary.numbers(["@end", "@start"]))
