"""Paraphrases by link: launch a campaign, give prompts, take what contributors write."""
