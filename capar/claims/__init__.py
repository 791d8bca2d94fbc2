"""Tests of motion: claims about captures, the files that hold them, and a pytest plugin."""
