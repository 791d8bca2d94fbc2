"""The address of a segment as every command prints and reads it."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

from capar.model.errors import CaparError, UnknownNameError
from capar.model.observation import ObservedLink, Segment

FORM = "CAPTURE/END_EFFECTOR/INDEX"
EXAMPLE = "drink_from_mug/right_hand/3"


class AddressError(CaparError):
    """A text that is no address of a segment."""


@dataclass(frozen=True, slots=True)
class SegmentAddress:
    """Which segment is meant: of which end-effector, counted from zero, in which capture."""

    ee: str
    index: int
    """Its number in the link, from zero."""

    capture: str = ""
    """Name or path of the capture; empty where there is only one."""

    def __post_init__(self) -> None:
        """Check that the address can be read back from its text.

        Raises:
            AddressError: The end-effector is empty or has a slash, or the index is negative.
        """
        if not self.ee or "/" in self.ee or self.index < 0:
            raise AddressError(
                f"end-effector {self.ee!r} and index {self.index} are no address of a segment; "
                "an end-effector has a name without '/', an index is 0 or more"
            )

    @classmethod
    def parse(cls, text: str) -> Self:
        """The address that a text states; the capture may itself contain slashes.

        Raises:
            AddressError: It is no address; the message says what one looks like.
        """
        *before, ee, index = ["", *text.strip().rsplit("/", 2)][-3:]
        if not ee or not (index.isascii() and index.isdecimal()):
            raise AddressError(
                f"{text!r} is no address of a segment; write {FORM}, such as {EXAMPLE}, "
                "and leave CAPTURE out where there is only one"
            )
        return cls(ee, int(index), "".join(before))

    def __str__(self) -> str:
        """The text from which ``parse`` reads the address back."""
        capture = f"{self.capture}/" if self.capture else ""
        return f"{capture}{self.ee}/{self.index}"


def split_capture(text: str) -> tuple[str, SegmentAddress]:
    """The capture that an address names, and the address within it.

    Raises:
        AddressError: It is no address, or names no capture.
    """
    address = SegmentAddress.parse(text)
    if not address.capture:
        raise AddressError(f"{text!r} names no capture; write {FORM}, such as {EXAMPLE}")
    return address.capture, replace(address, capture="")


def find_segment(
    links: Iterable[ObservedLink], address: SegmentAddress, *, capture: str
) -> Segment:
    """The segment at an address.

    Args:
        links: The links of one capture.
        address: With that capture's name, or without any.
        capture: The capture's name.

    Raises:
        UnknownNameError: The address names another capture, or a segment that is not there.
    """
    if address.capture not in {"", capture}:
        raise UnknownNameError("capture", address.capture, [capture])
    known = {
        str(SegmentAddress(segment.ee, segment.index)): segment
        for link in links
        for segment in link.segments
    }
    name = str(SegmentAddress(address.ee, address.index))
    if name not in known:
        raise UnknownNameError("segment", name, known, where=capture)
    return known[name]
