"""A fake device for machines without a GPU: its tensors compute on the CPU, but an operation may not
mix them with those of the CPU."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest
import torch
from torch.optim import optimizer
from torch.overrides import TorchFunctionMode
from torch.utils import _foreach_utils
from torch.utils._python_dispatch import TorchDispatchMode, return_and_correct_aliasing

CPU = torch.device("cpu")
FAKE = torch.device("meta")  # the only other device for which torch's autograd needs no hardware
CALLERS = (
    "seq2seq.seq2seq_parser",
    "ranker.fitting",
    "t5.t5_parser",
    "word_vectors.contextual",
    "elmo.encoder",
    "elmo.files",
)  # the modules that call processor()
ATEN = torch.ops.aten
PACK = ATEN._pack_padded_sequence.default
# Operations that may mix devices: copies, indices, and the lengths of packed sequences, which torch
# wants on the CPU.
MAY_MIX = {
    ATEN.copy_.default,
    ATEN.index.Tensor,
    ATEN.index_put_.default,
    ATEN._index_put_impl_.default,
    ATEN._pack_padded_sequence_backward.default,
    PACK,
}


@contextmanager
def computing_on(device: torch.device) -> Iterator[None]:
    """Let parsers compute on ``device``: the CPU, a GPU that is there, or ``FAKE``."""
    with ExitStack() as stack:
        patch = stack.enter_context(pytest.MonkeyPatch.context())
        for module in CALLERS:
            patch.setattr(f"parser_service.neural.{module}.processor", lambda: device)
        if device == FAKE:
            fused = [*_foreach_utils._get_fused_kernels_supported_devices(), FAKE.type]
            patch.setattr(optimizer, "_get_fused_kernels_supported_devices", lambda: fused)
            stack.enter_context(_FakeFactories())
            stack.enter_context(_FakeOperations())
        yield


class FakeTensor(torch.Tensor):
    """A tensor on ``FAKE``; ``inner``, on the CPU, holds its numbers."""

    @staticmethod
    def __new__(cls, inner):
        return torch.Tensor._make_wrapper_subclass(
            cls,
            inner.shape,
            strides=inner.stride(),
            storage_offset=inner.storage_offset(),
            dtype=inner.dtype,
            device=FAKE,
        )

    def __init__(self, inner):
        self.inner = inner

    @classmethod
    def __torch_dispatch__(cls, function, types, args=(), kwargs=None):
        raise AssertionError(f"{function} ran outside of computing_on(FAKE)")


class _FakeFactories(TorchFunctionMode):
    """Makes ``torch.tensor`` create fake tensors: the other mode does not see on which device it does."""

    def __torch_function__(self, function, types, args=(), kwargs=None):
        kwargs = dict(kwargs or {})
        if function is torch.tensor and kwargs.get("device") == FAKE:
            return function(*args, **{**kwargs, "device": CPU}).to(FAKE)
        return function(*args, **kwargs)


class _FakeOperations(TorchDispatchMode):
    """Computes with fake tensors, and refuses what a GPU would refuse: tensors of two devices in one
    operation, and random numbers from a generator on the CPU."""

    def __torch_dispatch__(self, function, types, args=(), kwargs=None):
        kwargs = dict(kwargs or {})
        given = [*_leaves((args, *kwargs.values()))]
        is_fake = any(isinstance(each, FakeTensor) for each in given)
        if is_fake and function not in MAY_MIX:
            _refuse_mixture(function, given)
        if kwargs.get("device") is not None:
            is_fake = kwargs["device"] == FAKE
            kwargs["device"] = CPU if is_fake else kwargs["device"]
        inner_kwargs = {name: _unwrap(each) for name, each in kwargs.items()}
        result = function(*_unwrap(args), **inner_kwargs)
        if not is_fake:
            return result
        if function is PACK:
            return FakeTensor(result[0]), result[1]
        result = _wrap(result)
        return return_and_correct_aliasing(function, args, kwargs, result)


def _leaves(value):
    """What an operation is given or gives, without the lists and tuples around it."""
    if isinstance(value, list | tuple):
        for each in value:
            yield from _leaves(each)
    else:
        yield value


def _unwrap(value):
    if isinstance(value, list | tuple):
        return type(value)(map(_unwrap, value))
    return value.inner if isinstance(value, FakeTensor) else value


def _wrap(value):
    if isinstance(value, list | tuple):
        return type(value)(map(_wrap, value))
    return FakeTensor(value) if isinstance(value, torch.Tensor) else value


def _refuse_mixture(function, given):
    for each in given:
        is_on_cpu = (
            isinstance(each, torch.Tensor) and not isinstance(each, FakeTensor) and each.dim()
        )
        if is_on_cpu or isinstance(each, torch.Generator):
            raise RuntimeError(f"{function} mixes tensors on the CPU and on {FAKE}")
