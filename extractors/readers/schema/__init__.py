"""The schema of capture.toml: its tables and keys, validation, messages and reference page."""
