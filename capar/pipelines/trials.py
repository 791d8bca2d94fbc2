"""The capture that a user means: a value, or a place to read one from."""

from pathlib import Path

from capar.model.capture import Capture
from capar.model.errors import CaparError
from extractors.contact.contacts import with_meeting_hands
from extractors.readers.bundle.capture_toml import read_capture


def trial_of(capture: Capture | Path | str) -> Capture:
    """The capture itself, or read from a folder with a capture.toml.

    Hands of one person that meet are objects in it too.

    Raises:
        CaparError: It is neither a capture nor a place, or there is none at that place.
    """
    if isinstance(capture, Capture):
        return with_meeting_hands(capture)
    if not isinstance(capture, str | Path):
        raise CaparError(
            f"expected a Capture, or the folder of a capture.toml, found "
            f"{type(capture).__name__}: {capture!r}"
        )
    return read_capture(capture)
