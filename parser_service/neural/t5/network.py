"""A pretrained encoder–decoder whose vocabulary has a token of its own for each atom of a form."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import torch
from safetensors.torch import save_file
from tokenizers import Tokenizer
from torch import Tensor, nn
from torch.nn.utils.rnn import pad_sequence

from annotations.language.texts import MAX_INDEXED_BYTES, Refusal
from parser_service.neural.t5.published_weights import PretrainedWriter
from parser_service.neural.t5.spelling import words_of
from parser_service.neural.weights import WEIGHTS, load_tensors
from parser_service.parsers.storage import read_json, write_json

if TYPE_CHECKING:
    from transformers import PreTrainedModel

NETWORK = "network.json"
TOKENIZER = "tokenizer.json"
FILES = (NETWORK, TOKENIZER, WEIGHTS)
LONGEST = (
    512  # tokens of an utterance where the network sets no limit: T5 was pretrained on so many
)


@dataclass(frozen=True, slots=True)
class SourceTokens:
    """The tokens of an utterance; ``cut`` counts those at its end that the encoder does not read."""

    tokens: list[int]
    cut: int = 0


class EncoderDecoder:
    """The network, its tokenizer for utterances, and the atoms that it writes forms with.

    The number of an atom is that of its place after the ``first`` rows, which are the pretrained
    vocabulary's. Of an utterance it reads the ``longest`` first tokens, of a form it writes at most
    ``most_written``. The tokenizer does not know atoms, so that utterances are read as in pretraining.
    """

    def __init__(
        self, model: PreTrainedModel, tokenizer: Tokenizer, atoms: Sequence[str], first: int
    ):
        self.model: Any = model  # whose own types say too little
        self.tokenizer = tokenizer
        self.atoms = tuple(atoms)
        self.first = first
        self.numbers = {atom: first + place for place, atom in enumerate(self.atoms)}
        config = model.config
        self.start, self.end = int(config.decoder_start_token_id), int(config.eos_token_id)
        self.padding = int(config.pad_token_id)
        positions = getattr(config, "max_position_embeddings", None)  # T5 has no such limit
        self.longest = min(LONGEST, positions or LONGEST)
        self.most_written = positions or MAX_INDEXED_BYTES
        tokenizer.no_truncation()
        tokenizer.no_padding()

    @classmethod
    def of(cls, pretrained: PretrainedWriter, atoms: Sequence[str]) -> Self:
        """Return a published network with a vector for each of ``atoms``: the mean of the vectors that its
        English words have. Raises Refusal."""
        model: Any = pretrained.model
        folder = pretrained.folder
        for name in ("decoder_start_token_id", "eos_token_id", "pad_token_id"):
            if not isinstance(getattr(model.config, name, None), int):
                raise Refusal(
                    f"The configuration in {folder} has no {name}, so it is not known how the decoder "
                    "starts and ends. Use the files of a published T5, FLAN-T5 or BART.",
                    "pretrained_weights_unreadable",
                )
        first = model.get_input_embeddings().num_embeddings
        if pretrained.tokenizer.get_vocab_size() > first:
            raise Refusal(
                f"The tokenizer in {folder} knows more tokens than the network has vectors. Put "
                "the files of one model there.",
                "pretrained_weights_unreadable",
            )
        network = cls(model, pretrained.tokenizer, atoms, first)
        network._grow()
        return network

    @classmethod
    def described_in(cls, folder: Path) -> Self:
        """Return the network that ``save`` wrote. Raises Refusal."""
        from transformers import AutoConfig, AutoModelForSeq2SeqLM
        from transformers.initialization import no_init_weights

        about = read_json(folder / NETWORK)
        values = dict(about["config"])
        config = AutoConfig.for_model(values.pop("model_type"), **values)
        with no_init_weights():
            model = AutoModelForSeq2SeqLM.from_config(config)  # type: ignore[no-untyped-call]
        share_weights(model, about["shared"])
        tokenizer = Tokenizer.from_file(str(folder / TOKENIZER))
        network = cls(model, tokenizer, about["atoms"], about["first"])
        network.load(load_tensors(folder / WEIGHTS), folder / WEIGHTS)
        return network

    def save(self, folder: Path) -> None:
        """Write ``FILES`` into ``folder``."""
        config = json.loads(self.model.config.to_json_string(use_diff=False))
        about = {"config": config, "atoms": self.atoms, "first": self.first}
        write_json(folder / NETWORK, {**about, "shared": shared_weights(self.model)})
        self.tokenizer.save(str(folder / TOKENIZER))
        tensors = {name: value.detach().contiguous() for name, value in self.tensors().items()}
        save_file(tensors, folder / WEIGHTS)

    def move_to(self, device: torch.device) -> None:
        """Compute on ``device``, without dropout until it is trained."""
        shared = shared_weights(self.model)
        self.model.to(device).eval()
        share_weights(self.model, shared)  # some devices copy a weight for each layer that has it

    def tensors(self) -> dict[str, Tensor]:
        """Return weights and other state by name, each once where layers share them."""
        saved = self.model.state_dict().keys()
        buffers = {name: b for name, b in self.model.named_buffers() if name in saved}
        return {**dict(self.model.named_parameters()), **buffers}

    @torch.no_grad()
    def load(self, values: Mapping[str, Tensor], source: Path) -> None:
        """Take the state that ``tensors`` returned. Raises Refusal where it is that of
        another network."""
        mine = self.tensors()
        if {n: t.shape for n, t in mine.items()} != {n: t.shape for n, t in values.items()}:
            raise Refusal(
                f"{source} holds the weights of another model; train it again.",
                "saved_parser_unreadable",
                HTTPStatus.CONFLICT,
            )
        for name, tensor in mine.items():
            tensor.copy_(values[name])

    def read(self, utterance: str) -> SourceTokens:
        """Return the tokens of an utterance, with those that the tokenizer adds at both ends."""
        tokens: list[int] = self.tokenizer.encode(utterance).ids
        if not tokens or tokens[-1] != self.end:
            tokens = [*tokens, self.end]
        # What is too long is cut before the last token, which ends the utterance.
        cut = max(0, len(tokens) - self.longest)
        return SourceTokens([*tokens[: self.longest - 1], tokens[-1]] if cut else tokens, cut)

    def write(self, atoms: Sequence[str]) -> list[int]:
        """Return the tokens of the form that is spelled so, the end included."""
        return [*(self.numbers[atom] for atom in atoms), self.end]

    def text(self, tokens: Sequence[int]) -> list[str]:
        """Return the atoms of tokens, and the texts of other tokens between them."""
        texts: list[str] = []
        for token in tokens:
            place = token - self.first
            texts.append(self.atoms[place] if place >= 0 else self.tokenizer.decode([token]))
        return texts

    def sources(self, sources: Sequence[SourceTokens]) -> dict[str, Tensor]:
        """Return padded utterances and their masks, each [batch, source length]."""
        rows = [torch.tensor(each.tokens) for each in sources]
        ids = pad_sequence(rows, batch_first=True, padding_value=self.padding)
        mask = pad_sequence([torch.ones_like(row) for row in rows], batch_first=True)
        device = self.model.device
        return {"input_ids": ids.to(device), "attention_mask": mask.to(device)}

    def logits(self, targets: Sequence[Sequence[int]], **inputs: Any) -> tuple[Tensor, Tensor]:
        """Return logits [batch, target length, vocabulary] of the tokens of ``targets``, and these tokens
        [batch, target length], -100 for padding."""
        rows = [torch.tensor(each) for each in targets]
        labels = pad_sequence(rows, batch_first=True, padding_value=-100).to(self.model.device)
        before = torch.full_like(labels[:, :1], self.start)
        shifted = torch.cat((before, labels[:, :-1]), 1)  # [batch, target length]
        shifted = shifted.masked_fill(shifted == -100, self.padding)
        return self.model(decoder_input_ids=shifted, use_cache=False, **inputs).logits, labels

    @torch.no_grad()
    def _grow(self) -> None:
        """Give each atom a row in the vectors that are read and those that are written."""
        model = self.model
        shared = shared_weights(model)
        written = model.get_output_embeddings().weight.clone()  # [first, width]
        model.resize_token_embeddings(self.first + len(self.atoms), mean_resizing=False)
        share_weights(model, shared)
        tables = [model.get_input_embeddings().weight]
        output = model.get_output_embeddings().weight
        if output is not tables[0]:
            # FLAN-T5 writes by other vectors than it reads, but resizing makes them the same.
            output[: self.first] = written
            tables.append(output)
        for atom, number in self.numbers.items():
            pieces = self.tokenizer.encode(words_of(atom), add_special_tokens=False).ids
            for table in tables:
                rows = table[pieces] if pieces else table[: self.first]  # [pieces, width]
                table[number] = rows.mean(0)


def shared_weights(model: nn.Module) -> dict[str, str]:
    """Return the names of weights that are those of an earlier name, with that name."""
    first: dict[int, str] = {}
    named = model.named_parameters(remove_duplicate=False)
    return {
        name: first[id(weight)]
        for name, weight in named
        if first.setdefault(id(weight), name) != name
    }


def share_weights(model: nn.Module, shared: Mapping[str, str]) -> None:
    """Make exactly those weights the same that ``shared_weights`` returned. What transformers shares by
    default is not what each published file holds."""
    seen: set[int] = set()
    for name, weight in list(model.named_parameters(remove_duplicate=False)):
        if name not in shared:
            if id(weight) in seen:
                _put(model, name, nn.Parameter(weight.detach().clone()))
            seen.add(id(weight))
    for name, other in shared.items():
        _put(model, name, model.get_parameter(other))


def _put(model: nn.Module, name: str, weight: nn.Parameter) -> None:
    layer, _, last = name.rpartition(".")
    setattr(model.get_submodule(layer), last, weight)
