"""What one answer of the ranker waits for: products of few rows with weights of 32, 16 and 8 bits.

    .venv/bin/python -m benchmarks.parsing.products [--saved FOLDER]

Prints microseconds of a product with a bias on one thread, in the shapes of all-MiniLM-L6-v2. Each figure is the
median over rounds through 24 layers, so that no cache holds their weights. With a saved ranker, also milliseconds of
whole answers: from 32 bits, and as it is served.
"""

from __future__ import annotations

import argparse
import os
import statistics
import time
from collections.abc import Callable
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"  # read once, when torch is loaded

import torch
from torch import Tensor
from torch.nn.functional import linear

from parser_service.neural.sentence_encoder.half_precision import (
    Linear,
    multiply,
    packed,
    rounded,
)

LAYERS, ROUNDS = 24, 30
SHAPES = (
    *((12, 384, 384), (12, 384, 1536), (12, 1536, 384)),
    *((32, 384, 1536), (128, 384, 1536), (256, 384, 1536)),
)
ASKED = "could you bring me the red object from the kitchen and put it down"


def microseconds(product: Callable[[int], object]) -> float:
    """Return the median of the microseconds of ``product``, which is given the number of a layer."""
    seconds = []
    for _ in range(ROUNDS):
        began = time.perf_counter()
        for layer in range(LAYERS):
            product(layer)
        seconds.append((time.perf_counter() - began) / LAYERS)
    return 1e6 * statistics.median(seconds)


def in_8_bits(weight: Tensor, bias: Tensor) -> object:
    steps = weight.abs().amax(1) / 127
    zeros = torch.zeros(len(weight), dtype=torch.long)
    whole = torch.quantize_per_channel(weight, steps, zeros, 0, torch.qint8)
    return torch.ops.quantized.linear_prepack(whole, bias)


def measure(rows: int, width: int, out: int) -> None:
    """Print the line of one shape."""
    weights = [rounded(torch.randn(out, width) / 20) for _ in range(LAYERS)]
    biases = [torch.randn(out) for _ in range(LAYERS)]
    given = torch.randn(rows, width)
    halves = [packed(*each) for each in zip(weights, biases, strict=True)]
    bytes_ = [in_8_bits(*each) for each in zip(weights, biases, strict=True)]
    times = (
        microseconds(lambda at: linear(given, weights[at], biases[at])),
        microseconds(lambda at: multiply(given, halves[at])),
        microseconds(lambda at: torch.ops.quantized.linear_dynamic(given, bytes_[at], True)),
    )
    print(
        f"| {rows}, {width}, {out} | {' | '.join(f'{each:,.0f}' for each in times)} |", flush=True
    )


def answers(folder: Path) -> None:
    """Print the median and the 95th percentile of answers, as they are served and from 32 bits, in turn."""
    from parser_service.neural.ranker.form_ranker import FormRanker
    from parser_service.neural.sentence_encoder.bert import SelfAttention

    served, plain = FormRanker.load(folder), FormRanker.load(folder)
    for layer in plain._model_or_refuse().modules():
        if isinstance(layer, (Linear, SelfAttention)):
            layer._packed = None
    milliseconds: dict[str, list[float]] = {"32 bits": [], "as served": []}
    for _ in range(600):
        for name, parser in zip(milliseconds, (plain, served), strict=True):
            began = time.perf_counter()
            parser.predict([ASKED], 5)
            milliseconds[name].append(1000 * (time.perf_counter() - began))
    for name, each in milliseconds.items():
        print(
            f"{name}: {statistics.median(each):.1f} ms, p95 {sorted(each)[int(0.95 * len(each))]:.1f} ms"
        )


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--saved", type=Path, metavar="FOLDER")
    saved = arguments.parse_args().saved
    if "fbgemm" not in torch.backends.quantized.supported_engines:
        raise SystemExit("torch has no products with packed weights for this processor.")
    print("| rows, in, out | 32 bits | 16 bits | 8 bits |")
    with torch.no_grad():
        for shape in SHAPES:
            measure(*shape)
    if saved:
        answers(saved)


if __name__ == "__main__":
    main()
