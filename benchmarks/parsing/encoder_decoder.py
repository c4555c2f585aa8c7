"""What the parser t5 costs with a network of a published size: memory, seconds a step, milliseconds an answer.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.encoder_decoder --size t5-small

The weights are random, so no accuracy is measured, and the tokenizer knows whole words: texts have a
third fewer tokens than with a published one. Trains for a few steps on the paraphrases of the published
corpus, then answers some of its validation pairs in each way of decoding.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import torch
from tokenizers import Tokenizer, models, pre_tokenizers, processors
from transformers import (
    BartConfig,
    BartForConditionalGeneration,
    PreTrainedModel,
    T5Config,
    T5ForConditionalGeneration,
)

from benchmarks.fresh_site import DATA
from parser_service.benchmarking.corpus import read_corpus
from parser_service.neural.t5.config import EncoderDecoderConfig
from parser_service.neural.t5.t5_parser import T5
from parser_service.parsers.interface import Observer, Pair

SPECIAL = ["<pad>", "</s>", "<unk>", "<s>"]
WORDS = 32_128  # rows of the published T5s
ASKED = 8
MEBI = 1024  # ru_maxrss is in kibibytes


def make_model(size: str) -> PreTrainedModel:
    """A random network of the published size."""
    if size == "bart-base":
        shape = {"d_model": 768, "encoder_layers": 6, "decoder_layers": 6, "vocab_size": 50_265}
        heads = {"encoder_attention_heads": 12, "decoder_attention_heads": 12}
        wide = {"encoder_ffn_dim": 3072, "decoder_ffn_dim": 3072}
        ends = {"pad_token_id": 0, "eos_token_id": 1, "bos_token_id": 3}
        sizes: Any = {**shape, **heads, **wide, **ends}
        return BartForConditionalGeneration(BartConfig(**sizes, decoder_start_token_id=1))
    shapes: dict[str, Any] = {
        "t5-small": {"d_model": 512, "d_ff": 2048, "num_layers": 6, "num_heads": 8},
        "t5-base": {"d_model": 768, "d_ff": 3072, "num_layers": 12, "num_heads": 12},
    }
    start: Any = {"decoder_start_token_id": 0}
    return T5ForConditionalGeneration(T5Config(vocab_size=WORDS, **start, **shapes[size]))


def write_checkpoint(folder: Path, size: str, pairs: list[Pair]) -> None:
    """Write it with a tokenizer of the words of ``pairs``, in the files of published ones."""
    words = sorted({word for pair in pairs for word in pair.utterance.lower().split()})
    tokenizer = Tokenizer(
        models.WordLevel({word: at for at, word in enumerate([*SPECIAL, *words])}, "<unk>")
    )
    tokenizer.pre_tokenizer = pre_tokenizers.Whitespace()
    tokenizer.post_processor = processors.TemplateProcessing(
        single="$A </s>", special_tokens=[("</s>", 1)]
    )
    tokenizer.save(str(folder / "tokenizer.json"))
    make_model(size).save_pretrained(folder)


def peak() -> str:
    """The most memory that this process has used, or the GPU has."""
    if torch.cuda.is_available():
        return f"{torch.cuda.max_memory_allocated() / 2**30:.1f} GB of the GPU"
    return f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / MEBI**2:.1f} GB"


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    sizes = ("t5-small", "t5-base", "bart-base")
    arguments.add_argument("--size", choices=sizes, default=sizes[0])
    arguments.add_argument("--steps", type=int, default=8, metavar="N")
    arguments.add_argument("--accumulation", type=int, default=1, metavar="N")
    given = arguments.parse_args()
    corpus = read_corpus(DATA / "walker2019", "command")
    pairs = corpus.pairs("train", ("paraphrased",))
    asked = [pair.utterance for pair in corpus.pairs("validation", ("paraphrased",))[:ASKED]]
    with tempfile.TemporaryDirectory() as name:
        write_checkpoint(Path(name), given.size, pairs)
        config = EncoderDecoderConfig(
            encoder=name, steps=given.steps, accumulation=given.accumulation
        )
        parser = T5(config)
        begin = time.monotonic()
        training = parser._prepare(pairs, Observer())
        print(f"{given.size}: {parser.parameters() / 1e6:.0f} million weights, {peak()} when read")
        prepared = time.monotonic()
        while not training.is_over():
            training.run_step(lambda: None)
        print(
            f"{(time.monotonic() - prepared) / given.steps:.2f} s a step of {config.batch_size} pairs in "
            f"{given.accumulation} parts, {prepared - begin:.0f} s before them; {peak()}"
        )
        for decoding in ("free", "listed", "typed"):
            parser.config = replace(config, decoding=decoding)
            network, targets = parser._fitted()
            parser._set(network, targets)
            parser.predict(asked[:1])
            begin = time.monotonic()
            parser.predict(asked)
            spent = (time.monotonic() - begin) / len(asked)
            print(f"{decoding}: {1000 * spent:.0f} ms an answer, {len(asked)} asked together")


if __name__ == "__main__":
    main()
