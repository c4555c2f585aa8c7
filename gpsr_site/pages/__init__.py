"""Pages that look at both apps, and what every page shows around its content."""
