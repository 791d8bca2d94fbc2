"""The file formats that motion is read from, one module each."""
