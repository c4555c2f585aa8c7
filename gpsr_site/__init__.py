"""The installation: settings, routes and what looks at both apps."""
