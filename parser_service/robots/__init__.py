"""What the robot of a world needs of it: names of actions, and which words of an utterance go where."""
