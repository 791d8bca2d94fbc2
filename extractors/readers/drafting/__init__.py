"""A first capture.toml from what files hold."""
