"""What takes long or takes files: jobs, imports, generation, downloads."""
