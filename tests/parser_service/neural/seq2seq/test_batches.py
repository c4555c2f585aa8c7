import torch

from parser_service.neural.seq2seq.batches import NumberedPair, collate, in_order, shuffle
from parser_service.neural.seq2seq.vocabulary import END, PADDING, START

EXAMPLES = [NumberedPair([5] * (n % 4), [6 + n] * (n % 9 + 1)) for n in range(150)]


def seen(batches):
    """The first token of every form, in the order of the batches."""
    return [token for batch in batches for token in batch.inputs[:, 1].tolist()]


def test_pairs_are_padded_and_closed():
    batch = collate([NumberedPair([4, 5], [7]), NumberedPair([], [8, 9])])
    assert batch.source.tolist() == [[4, 5, END], [END, PADDING, PADDING]]
    assert batch.lengths.tolist() == [3, 1]
    assert batch.inputs.tolist() == [[START, 7, PADDING], [START, 8, 9]]
    assert batch.outputs.tolist() == [[7, END, PADDING], [8, 9, END]]


def test_an_epoch_sees_every_example_once():
    batches = list(shuffle(EXAMPLES, 16, torch.Generator().manual_seed(1)))
    assert sorted(seen(batches)) == [example.target[0] for example in EXAMPLES]
    assert max(len(batch.lengths) for batch in batches) == 16


def test_the_order_depends_on_the_generator_alone():
    orders = [seen(shuffle(EXAMPLES, 16, torch.Generator().manual_seed(s))) for s in (1, 1, 2)]
    assert orders[0] == orders[1] != orders[2]


def test_an_epoch_differs_from_the_one_before():
    generator = torch.Generator().manual_seed(1)
    assert seen(shuffle(EXAMPLES, 16, generator)) != seen(shuffle(EXAMPLES, 16, generator))


def test_batches_hold_forms_of_like_length():
    def padding(batches):
        return sum((batch.outputs == PADDING).sum().item() for batch in batches)

    bucketed = shuffle(EXAMPLES, 16, torch.Generator().manual_seed(1))
    assert padding(bucketed) < padding(in_order(EXAMPLES, 16)) / 2


def test_in_order_keeps_the_order():
    assert seen(in_order(EXAMPLES, 16)) == [example.target[0] for example in EXAMPLES]
