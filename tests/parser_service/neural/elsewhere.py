"""A second device for machines that have none: its tensors compute on the CPU, but may not meet
the CPU's."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest
import torch
from torch.optim import optimizer
from torch.overrides import TorchFunctionMode
from torch.utils import _foreach_utils
from torch.utils._python_dispatch import TorchDispatchMode, return_and_correct_aliasing
from torch.utils._pytree import tree_leaves, tree_map_only

CPU = torch.device("cpu")
ELSEWHERE = torch.device("meta")  # the one other name for which torch's autograd needs no hardware
ASK_FOR_IT = (
    "seq2seq",
    "ranker",
    "contextual",
    "elmo",
    "elmo_weights",
)  # the modules that call processor()
ATEN = torch.ops.aten
PACK = ATEN._pack_padded_sequence.default
# What torch takes from two devices as well: copies, places to read or write, and the lengths of
# packed sequences, which it wants on the CPU.
MIXING = {
    ATEN.copy_.default,
    ATEN.index.Tensor,
    ATEN.index_put_.default,
    ATEN._index_put_impl_.default,
    ATEN._pack_padded_sequence_backward.default,
    PACK,
}


@contextmanager
def computing_on(device: torch.device) -> Iterator[None]:
    """Lets parsers compute on ``device``: the CPU, a GPU that is there, or ``ELSEWHERE``."""
    with ExitStack() as stack:
        patch = stack.enter_context(pytest.MonkeyPatch.context())
        for module in ASK_FOR_IT:
            patch.setattr(f"parser_service.neural.{module}.processor", lambda: device)
        if device == ELSEWHERE:
            fused = [*_foreach_utils._get_fused_kernels_supported_devices(), ELSEWHERE.type]
            patch.setattr(optimizer, "_get_fused_kernels_supported_devices", lambda: fused)
            stack.enter_context(_Making())
            stack.enter_context(_Meeting())
        yield


class Far(torch.Tensor):
    """A tensor on ``ELSEWHERE``; ``near`` holds its numbers."""

    @staticmethod
    def __new__(cls, near):
        return torch.Tensor._make_wrapper_subclass(
            cls,
            near.shape,
            strides=near.stride(),
            storage_offset=near.storage_offset(),
            dtype=near.dtype,
            device=ELSEWHERE,
        )

    def __init__(self, near):
        self.near = near

    @classmethod
    def __torch_dispatch__(cls, function, types, args=(), kwargs=None):
        raise AssertionError(f"{function} ran outside of computing_on(ELSEWHERE)")


class _Making(TorchFunctionMode):
    """``torch.tensor`` hides from the other mode where it makes one."""

    def __torch_function__(self, function, types, args=(), kwargs=None):
        kwargs = dict(kwargs or {})
        if function is torch.tensor and kwargs.get("device") == ELSEWHERE:
            return function(*args, **{**kwargs, "device": CPU}).to(ELSEWHERE)
        return function(*args, **kwargs)


class _Meeting(TorchDispatchMode):
    """Computes with ``Far`` tensors, and refuses what a GPU would refuse: tensors of two devices in
    one operation, and numbers drawn for it by a generator of the CPU."""

    def __torch_dispatch__(self, function, types, args=(), kwargs=None):
        kwargs = dict(kwargs or {})
        given = tree_leaves((args, kwargs))
        is_far = any(isinstance(each, Far) for each in given)
        if is_far and function not in MIXING:
            _refuse_mixture(function, given)
        if kwargs.get("device") is not None:
            is_far = kwargs["device"] == ELSEWHERE
            kwargs["device"] = CPU if is_far else kwargs["device"]
        near_args, near_kwargs = tree_map_only(Far, lambda each: each.near, (args, kwargs))
        found = function(*near_args, **near_kwargs)
        if not is_far:
            return found
        if function is PACK:
            return Far(found[0]), found[1]
        found = tree_map_only(torch.Tensor, Far, found)
        return return_and_correct_aliasing(function, args, kwargs, found)


def _refuse_mixture(function, given):
    for each in given:
        is_near = isinstance(each, torch.Tensor) and not isinstance(each, Far) and each.dim()
        if is_near or isinstance(each, torch.Generator):
            raise RuntimeError(f"{function} was given something of the CPU and of {ELSEWHERE}")
