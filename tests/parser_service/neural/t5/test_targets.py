from parser_service.neural.t5.targets import Trie


def test_what_follows_is_what_a_sequence_has_there():
    trie = Trie([[5, 6, 1], [5, 7, 1], [8, 1]])
    assert trie.continuations([]) == [5, 8]
    assert trie.continuations([5]) == [6, 7]
    assert trie.continuations([5, 6]) == [1]


def test_nothing_follows_the_end_or_what_no_sequence_begins_with():
    trie = Trie([[5, 1]])
    assert (
        trie.continuations([5, 1]) == trie.continuations([6]) == trie.continuations([5, 9, 9]) == []
    )
