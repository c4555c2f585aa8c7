"""Where torch computes, and in which numbers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager

import torch


def processor() -> torch.device:
    """The GPU where there is one."""
    return torch.device("cuda" if torch.cuda.is_available() else "cpu")


def has_bf16(device: torch.device) -> bool:
    """Whether a processor multiplies bf16 matrices itself; emulated they are slower than fp32."""
    if device.type == "cuda":
        return bool(torch.cuda.is_bf16_supported(including_emulation=False))
    found = torch.cpu.get_capabilities()
    return bool(found.get("avx512_bf16") or found.get("amx_bf16"))


@contextmanager
def denormals_flushed() -> Iterator[None]:
    """Takes numbers below 1e-38 for 0 inside the block. The activation of transformers makes such,
    and a CPU takes many times as long for one as for another number."""
    was_so = not float(torch.full((), 1e-39) / 2)
    torch.set_flush_denormal(True)
    try:
        yield
    finally:
        torch.set_flush_denormal(was_so)


def bf16_on_gpu(device: torch.device) -> AbstractContextManager[object]:
    """Lets a GPU that has it multiply in bf16 inside the block; other processors stay in fp32."""
    is_able = device.type == "cuda" and has_bf16(device)
    return torch.autocast("cuda", torch.bfloat16, enabled=is_able)


def full_fp32() -> AbstractContextManager[None]:
    """Lets a GPU compute in the block what the CPU does, up to the last digits: else its library of
    recurrent and convolutional layers rounds factors to 10 bits. On the CPU nothing changes."""
    return torch.backends.cudnn.flags(enabled=True, allow_tf32=False)
