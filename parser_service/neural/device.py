"""Where torch computes, on how many cores and in which precision."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager

import torch


def processor() -> torch.device:
    """Return the GPU where there is one, else the CPU."""
    return torch.device("cuda" if torch.cuda.is_available() else "cpu")


def has_bf16(device: torch.device) -> bool:
    """Return whether a processor multiplies bf16 matrices in hardware; emulated they are slower than fp32."""
    if device.type == "cuda":
        return bool(torch.cuda.is_bf16_supported(including_emulation=False))
    capabilities = torch.cpu.get_capabilities()
    return bool(capabilities.get("avx512_bf16") or capabilities.get("amx_bf16"))


@contextmanager
def denormals_flushed() -> Iterator[None]:
    """Round numbers below 1e-38 to 0 inside the block. The activation of transformers makes such
    numbers, and a CPU takes many times as long for them as for others."""
    was_so = not float(torch.full((), 1e-39) / 2)
    torch.set_flush_denormal(True)
    try:
        yield
    finally:
        torch.set_flush_denormal(was_so)


def bf16_on_gpu(device: torch.device) -> AbstractContextManager[object]:
    """Multiply in bf16 inside the block on a GPU that supports it; other processors stay in fp32."""
    is_supported = device.type == "cuda" and has_bf16(device)
    return torch.autocast("cuda", torch.bfloat16, enabled=is_supported)


def full_fp32() -> AbstractContextManager[None]:
    """Compute on a GPU what the CPU would, up to the last digits, inside the block: by default its
    recurrent and convolutional layers round factors to 10 bits. On the CPU nothing changes."""
    return torch.backends.cudnn.flags(enabled=True, allow_tf32=False)


@contextmanager
def threads(number: int) -> Iterator[None]:
    """Let torch use ``number`` cores inside the block; 0: as many as it uses already."""
    before = torch.get_num_threads()
    torch.set_num_threads(number or before)
    try:
        yield
    finally:
        torch.set_num_threads(before)
