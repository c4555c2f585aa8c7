"""Compare the weights of parsers, or replace them."""

import torch


def weights(parser):
    return {name: value.detach().clone() for name, value in parser._network.tensors().items()}


def same_weights(one, other):
    return all(torch.equal(value, weights(other)[name]) for name, value in weights(one).items())


def make_random(parser, seed):
    """Gives a parser far-off weights, so that it writes whatever it may."""
    with torch.random.fork_rng(devices=[]), torch.no_grad():
        torch.manual_seed(seed)
        for tensor in parser._network.tensors().values():
            tensor.normal_(std=0.5)
    return parser
