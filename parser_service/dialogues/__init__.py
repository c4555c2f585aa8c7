"""Talk with people about commands, keep what comes of it, and know what the robot calls its actions."""
