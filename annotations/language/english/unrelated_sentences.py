"""Sentences that are no command for a robot: data for probes."""

from __future__ import annotations

UNRELATED_SENTENCES = (
    "It rained in the mountains last week.",
    "The price of wheat fell again in autumn.",
    "She has never liked the music of that century.",
    "Seven is a prime number.",
    "Our neighbours are getting married in June.",
    "The treaty was signed in Vienna in 1815.",
    "My left shoe is a size too small.",
    "Whales are mammals although they live in the sea.",
    "The train to Lisbon was forty minutes late.",
    "He dreamed about an endless staircase.",
    "Most of the audience left before the second act.",
    "Copper conducts electricity better than iron.",
    "I would rather be sailing today.",
    "The committee will vote on the budget tomorrow.",
    "Their goalkeeper broke two fingers.",
    "Nobody remembers who planted the oak tree.",
    "Light takes eight minutes from the sun to the earth.",
    "Her second novel sold better than the first.",
    "The volcano has been quiet for a century.",
    "You look a little tired this morning.",
)
