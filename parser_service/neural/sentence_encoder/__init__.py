"""A pretrained transformer that encodes each text as one vector, and can be fine-tuned."""

from parser_service.neural.sentence_encoder.encoder import ENCODER, TOKENIZER, SentenceEncoder
