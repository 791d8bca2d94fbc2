"""VerbNet 3.x as values: classes with members, roles, and frames of syntax and semantics."""

from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, order=True)
class Member:
    """A verb of a class."""

    lemma: str
    """Words joined by underscores: ``pick_up``."""

    keys: tuple[str, ...]
    """WordNet sense keys, complete; VerbNet takes them from several versions of WordNet."""


@dataclass(frozen=True, slots=True, order=True)
class Role:
    """A participant: Agent, Theme, Destination ..."""

    name: str
    restrictions: tuple[str, ...]
    """What may fill it: ``+solid``; alternatives joined by ``|``."""


@dataclass(frozen=True, slots=True, order=True)
class Predicate:
    """A part of a frame's meaning: ``!contact(e1, Agent, Experiencer)``."""

    name: str
    arguments: tuple[str, ...]
    """Events first; constants and specific arguments as VerbNet writes them."""

    holds: bool = True

    @property
    def event(self) -> str:
        """The event in which it holds, or empty."""
        return next((each for each in self.arguments if is_event(each)), "")

    def __str__(self) -> str:
        """As VerbNet prints it."""
        return f"{'' if self.holds else '!'}{self.name}({', '.join(self.arguments)})"


@dataclass(frozen=True, slots=True, order=True)
class Phrase:
    """A constituent of a frame's syntax: a role, the verb, prepositions, a fixed word."""

    kind: str
    """``NP``, ``VERB``, ``PREP``, ``LEX``, ``ADJ``, ``ADV`` or ``VP``."""

    value: str
    """The role; for a preposition those that fit, or the restriction such as ``+path``."""


@dataclass(frozen=True, slots=True, order=True)
class Frame:
    """One way to use the verbs of a class, and what it then means."""

    pattern: str
    """``NP V NP PP.destination``."""

    example: str
    syntax: tuple[Phrase, ...]
    semantics: tuple[Predicate, ...]


@dataclass(frozen=True, slots=True)
class VerbClass:
    """A class with what it states itself; what it inherits stands with its parents."""

    id: str
    """``touch-20-1``."""

    parent: str
    """The class that it refines, or empty."""

    members: tuple[Member, ...]
    roles: tuple[Role, ...]
    frames: tuple[Frame, ...]
    subclasses: tuple["VerbClass", ...]

    @property
    def number(self) -> str:
        """``20-1``: what follows the name."""
        return self.id.partition("-")[2]

    @property
    def levin(self) -> str:
        """``20``: the number without those of the subclass."""
        return self.number.partition("-")[0]

    @property
    def family(self) -> Iterator["VerbClass"]:
        """The class and every class below it, top down."""
        yield self
        for subclass in self.subclasses:
            yield from subclass.family


def is_event(argument: str) -> bool:
    """Whether an argument is one of VerbNet's event variables: ``e1``, ``ë2``, ``E``."""
    return argument[:1] in {"e", "ë", "E"} and (argument[1:].isdigit() or len(argument) == 1)
