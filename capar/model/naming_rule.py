"""The rule by which segments got a name, as text and with the thresholds that it rests on."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, order=True)
class Threshold:
    """A number that rules decide by."""

    name: str
    """With its unit at its end: ``height_mm``."""

    value: int


@dataclass(frozen=True, slots=True, order=True)
class NamingRule:
    """What defines a name of segments in the rule base that named them."""

    name: str
    file: str
    """The rule file, by its folder and its name."""

    sha256: str
    """Of the file's text."""

    text: str
    thresholds: tuple[Threshold, ...]
    """Those that the definition reads, and the vocabulary that it names, by name; those by which
    segments are cut are not among them."""
