"""Check what people write, while they type and before they delete, and keep stored problems up to date."""
