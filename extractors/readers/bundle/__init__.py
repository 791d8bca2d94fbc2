"""The capture bundle: capture.toml and the files that it names, as a capture."""
