"""A parser that shows a language model the nearest training pairs as examples.

``chat_messages`` says what it is told, ``language_model`` asks, and ``mending`` holds the answer to the world.
"""
