"""Weights small enough for tests, in the formats in which GloVe, ELMo, GPT and BERT are published."""

import gzip
import json
from pathlib import Path

import h5py
import numpy
import torch
from safetensors.torch import load_file, save_file
from tokenizers import Tokenizer, models, normalizers, pre_tokenizers, processors, trainers

TEXT = ["bring me the apple from the kitchen", "find a person in the room", "object location"]
ELMO = {
    "char_cnn": {
        "activation": "relu",
        "embedding": {"dim": 4},
        "filters": [[1, 4], [2, 5], [3, 6]],
        "max_characters_per_token": 12,
        "n_characters": 262,
        "n_highway": 2,
    },
    "lstm": {
        "cell_clip": 0.5,
        "dim": 10,
        "n_layers": 2,
        "proj_clip": 0.3,
        "projection_dim": 6,
        "use_skip_connections": True,
    },
}


def write_glove(path: Path, words, size: int, packed: bool = False) -> Path:
    random = numpy.random.default_rng(0)
    rows = [f"{word} {' '.join(f'{x:.4f}' for x in random.normal(size=size))}" for word in words]
    text = "".join(f"{row}\n" for row in rows).encode()
    path.write_bytes(gzip.compress(text) if packed else text)
    return path


def write_elmo(folder: Path, seed: int = 0) -> Path:
    """Random weights under the names of the published HDF5 file."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "tiny_options.json").write_text(json.dumps(ELMO))
    random = numpy.random.default_rng(seed)
    with h5py.File(folder / "tiny_weights.hdf5", "w") as file:
        for name, shape in elmo_shapes().items():
            file[name] = random.normal(scale=0.7, size=shape).astype("float32")
    return folder


def elmo_shapes():
    characters, filters = ELMO["char_cnn"]["embedding"]["dim"], ELMO["char_cnn"]["filters"]
    cells, size = ELMO["lstm"]["dim"], ELMO["lstm"]["projection_dim"]
    wide = sum(number for _, number in filters)
    shapes = {"char_embed": (261, characters)}
    for index, (width, number) in enumerate(filters):
        shapes[f"CNN/W_cnn_{index}"] = (1, width, characters, number)
        shapes[f"CNN/b_cnn_{index}"] = (number,)
    for index in range(ELMO["char_cnn"]["n_highway"]):
        for name in ("carry", "transform"):
            shapes[f"CNN_high_{index}/W_{name}"] = (wide, wide)
            shapes[f"CNN_high_{index}/b_{name}"] = (wide,)
    shapes |= {"CNN_proj/W_proj": (wide, size), "CNN_proj/b_proj": (size,)}
    for direction in (0, 1):
        for layer in range(ELMO["lstm"]["n_layers"]):
            cell = f"RNN_{direction}/RNN/MultiRNNCell/Cell{layer}/LSTMCell"
            shapes[f"{cell}/W_0"] = (2 * size, 4 * cells)
            shapes[f"{cell}/B"] = (4 * cells,)
            shapes[f"{cell}/W_P_0"] = (cells, size)
    return shapes


def write_bert(folder: Path, seed: int = 0) -> Path:
    """A BERT with a WordPiece tokenizer that cuts words."""
    from transformers import BertConfig, BertForPreTraining

    tokenizer = Tokenizer(models.WordPiece(unk_token="[UNK]"))
    tokenizer.normalizer = normalizers.BertNormalizer()
    tokenizer.pre_tokenizer = pre_tokenizers.BertPreTokenizer()
    special = ["[PAD]", "[UNK]", "[CLS]", "[SEP]"]
    tokenizer.train_from_iterator(
        TEXT, trainers.WordPieceTrainer(vocab_size=50, special_tokens=special)
    )
    tokenizer.post_processor = processors.BertProcessing(("[SEP]", 3), ("[CLS]", 2))
    config = BertConfig(
        vocab_size=tokenizer.get_vocab_size(),
        hidden_size=8,
        num_hidden_layers=2,
        num_attention_heads=2,
        intermediate_size=16,
        max_position_embeddings=40,
    )
    _write(folder, BertForPreTraining, config, tokenizer, seed)
    path = folder / "model.safetensors"
    save_file({_first_name(name): value for name, value in load_file(path).items()}, path)
    return path.parent


def _first_name(name: str) -> str:
    """The name that a weight has in the first BERTs, which is how they are still published."""
    if ".LayerNorm." not in name:
        return name
    return name.replace(".weight", ".gamma").replace(".bias", ".beta")


def write_gpt(folder: Path, seed: int = 0) -> Path:
    """OpenAI's first GPT with byte pairs that end words with a sign."""
    from transformers import OpenAIGPTConfig, OpenAIGPTModel

    tokenizer = Tokenizer(models.BPE(unk_token="<unk>", end_of_word_suffix="</w>"))
    tokenizer.normalizer = normalizers.BertNormalizer()
    tokenizer.pre_tokenizer = pre_tokenizers.BertPreTokenizer()
    learning = trainers.BpeTrainer(
        vocab_size=60, special_tokens=["<unk>"], end_of_word_suffix="</w>"
    )
    tokenizer.train_from_iterator(TEXT, learning)
    config = OpenAIGPTConfig(
        vocab_size=tokenizer.get_vocab_size(), n_positions=40, n_embd=8, n_layer=2, n_head=2
    )
    return _write(folder, OpenAIGPTModel, config, tokenizer, seed)


def _write(folder, model, config, tokenizer, seed):
    folder.mkdir(parents=True, exist_ok=True)
    tokenizer.save(str(folder / "tokenizer.json"))
    (folder / "tokenizer_config.json").write_text('{"model_max_length": 512}')
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        model(config).save_pretrained(folder)
    return folder
