"""A T5 and a BART small enough for tests, in the files of published ones."""

from pathlib import Path

import torch
from safetensors.torch import load_file, save_file
from tokenizers import Tokenizer, decoders, models, pre_tokenizers, processors, trainers

TEXT = [
    "bring me the apple from the kitchen",
    "find a person in the room and follow him",
    "object name location look for fetch at is end",
]
WIDTH = 32


def write_t5(folder: Path, seed: int = 0) -> Path:
    """Random weights of a FLAN-T5 of one layer each, which writes by other vectors than it reads, with a
    sentence-piece tokenizer that lacks ``<``."""
    from transformers import T5Config, T5ForConditionalGeneration

    words = sorted({f"▁{word}" for text in TEXT for word in text.split()})
    pieces = ["<pad>", "</s>", "<unk>", "▁", *words, *"abcdefghijklmnopqrstuvwxyz>"]
    scores = [(piece, 0.0 if at < 3 else -float(at)) for at, piece in enumerate(pieces)]
    tokenizer = Tokenizer(models.Unigram(scores, unk_id=2, byte_fallback=False))
    tokenizer.pre_tokenizer = pre_tokenizers.Metaspace()
    tokenizer.decoder = decoders.Metaspace()
    tokenizer.post_processor = processors.TemplateProcessing(
        single="$A </s>", special_tokens=[("</s>", 1)]
    )
    config = T5Config(
        vocab_size=tokenizer.get_vocab_size() + 5,  # published ones have more rows than pieces, too
        d_model=WIDTH,
        d_kv=16,
        d_ff=64,
        num_layers=1,
        num_heads=2,
        decoder_start_token_id=0,
        dropout_rate=0.05,
        feed_forward_proj="gated-gelu",
        tie_word_embeddings=False,
    )
    _write(folder, T5ForConditionalGeneration, config, tokenizer, seed)
    path = folder / "model.safetensors"
    tensors = load_file(path)
    generator = torch.Generator().manual_seed(seed)
    tensors["lm_head.weight"] = torch.randn(tensors["shared.weight"].shape, generator=generator) / 6
    save_file(tensors, path, {"format": "pt"})
    return folder


def write_bart(folder: Path, seed: int = 0) -> Path:
    """Random weights of a BART of one layer each, with byte pairs, that reads 40 of them."""
    from transformers import BartConfig, BartForConditionalGeneration

    special = ["<s>", "<pad>", "</s>", "<unk>"]
    tokenizer = Tokenizer(models.BPE())
    tokenizer.pre_tokenizer = pre_tokenizers.ByteLevel()
    tokenizer.decoder = decoders.ByteLevel()
    alphabet = pre_tokenizers.ByteLevel.alphabet()
    tokenizer.train_from_iterator(
        TEXT,
        trainers.BpeTrainer(
            vocab_size=330, special_tokens=special, initial_alphabet=alphabet, show_progress=False
        ),
    )
    tokenizer.post_processor = processors.RobertaProcessing(("</s>", 2), ("<s>", 0))
    config = BartConfig(
        vocab_size=tokenizer.get_vocab_size(),
        d_model=WIDTH,
        encoder_layers=1,
        decoder_layers=1,
        encoder_attention_heads=2,
        decoder_attention_heads=2,
        encoder_ffn_dim=64,
        decoder_ffn_dim=64,
        max_position_embeddings=40,
        dropout=0.05,
        init_std=0.1,
    )
    return _write(folder, BartForConditionalGeneration, config, tokenizer, seed)


def _write(folder, model, config, tokenizer, seed):
    from transformers import PreTrainedTokenizerFast

    folder.mkdir(parents=True, exist_ok=True)
    PreTrainedTokenizerFast(tokenizer_object=tokenizer).save_pretrained(folder)
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        model(config).save_pretrained(folder)
    return folder
