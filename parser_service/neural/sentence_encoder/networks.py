"""The networks that the ranker fine-tunes: ``Bert``, and what else transformers knows.

Transformers is imported for the latter alone: that takes longer than all else that answering does.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from parser_service.neural.sentence_encoder.bert import Bert, BertConfig, is_bert
from parser_service.neural.sentence_encoder.shared_dropout import share_dropout

if TYPE_CHECKING:
    from transformers import PreTrainedModel

    Network = Bert | PreTrainedModel


def describe(model: PreTrainedModel) -> dict[str, Any]:
    """Return the whole configuration of a network, ready for JSON."""
    description: dict[str, Any] = json.loads(model.config.to_json_string(use_diff=False))
    return description


def make_trainable(model: PreTrainedModel) -> Network:
    """Return a network with the weights of ``model`` to train, which may be ``model`` itself."""
    description = describe(model)
    if not is_bert(description):
        return _prepare(model)
    network = Bert(BertConfig.read(description))
    network.load_state_dict(model.state_dict())
    return network


def make_empty(description: Mapping[str, Any]) -> Network:
    """Return the network that ``describe`` described. Its weights are uninitialised memory."""
    if is_bert(description):
        return Bert(BertConfig.read(description))
    from transformers import AutoConfig, AutoModel
    from transformers.initialization import no_init_weights

    values = dict(description)
    config = AutoConfig.for_model(values.pop("model_type"), **values)
    with no_init_weights():
        model = AutoModel.from_config(config)  # type: ignore[no-untyped-call]
    return _prepare(model)


def _prepare(model: PreTrainedModel) -> PreTrainedModel:
    share_dropout(model)
    model.set_attn_implementation("eager")  # on short texts the fused one takes longer
    return model
