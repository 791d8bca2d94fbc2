"""Every file format that motion is read from, one module each."""
