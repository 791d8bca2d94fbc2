"""VerbNet 3.x as values, read from the XML files of a user's copy."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from defusedxml import ElementTree
from defusedxml.common import DefusedXmlException

from capar.model.errors import FileError
from kb.lexicon.wordnet import WordNet, normal_key

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element


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


REMEDY = "VerbNet 3.x holds one class a file, with <VNCLASS ID=...> at its top."


@dataclass(frozen=True, slots=True)
class KeyRate:
    """How many of the members' WordNet keys stand in WordNet 3.1."""

    keys: int
    resolved: int

    @property
    def share(self) -> float:
        """Resolved keys over all keys; one if there are none."""
        return self.resolved / self.keys if self.keys else 1.0


def read_verbnet(folder: Path) -> tuple[VerbClass, ...]:
    """Every class of a folder of VerbNet files, by file name.

    Raises:
        FileError: No folder, no class files in it, or one that is not VerbNet's.
    """
    if not folder.is_dir():
        raise FileError(folder, "is no folder;", "name the one that holds VerbNet's XML files.")
    paths = sorted(folder.glob("*.xml"))
    if not paths:
        raise FileError(folder, "holds no XML file;", "name the one that holds VerbNet's.")
    classes = tuple(read_class(path) for path in paths)
    _check_distinct(folder, classes)
    return classes


def read_class(path: Path) -> VerbClass:
    """The class of one file.

    Raises:
        FileError: No XML, XML that declares entities, or not a class of VerbNet.
    """
    try:
        root = ElementTree.parse(path).getroot()
    except DefusedXmlException as error:
        raise FileError(path, f"declares what no VerbNet file needs ({error});", REMEDY) from error
    except (ElementTree.ParseError, OSError, ValueError) as error:
        raise FileError(path, f"is no XML ({error});", REMEDY) from error
    if root is None or root.tag != "VNCLASS":
        raise FileError(path, f"begins with <{root.tag if root is not None else ''}>;", REMEDY)
    return _verb_class(root, "", path)


def key_rate(classes: Iterable[VerbClass], words: WordNet) -> KeyRate:
    """How many of the classes' member keys are verb senses of that WordNet."""
    keys = [
        key
        for top in classes
        for each in top.family
        for member in each.members
        for key in member.keys
    ]
    return KeyRate(len(keys), sum(key in words for key in keys))


def _check_distinct(folder: Path, classes: tuple[VerbClass, ...]) -> None:
    names = [each.id for top in classes for each in top.family]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise FileError(folder, f"has class {twice[0]} twice;", "keep one copy of each class.")


def _verb_class(element: "Element", parent: str, path: Path) -> VerbClass:
    name = _attribute(element, "ID", path)
    below = element.findall("SUBCLASSES/VNSUBCLASS")
    return VerbClass(
        name,
        parent,
        tuple(_member(each, path) for each in element.findall("MEMBERS/MEMBER")),
        tuple(_role(each, path) for each in element.findall("THEMROLES/THEMROLE")),
        tuple(_frame(each, path) for each in element.findall("FRAMES/FRAME")),
        tuple(_verb_class(each, name, path) for each in below),
    )


def _attribute(element: "Element", name: str, path: Path) -> str:
    value = element.get(name)
    if not value:
        raise FileError(path, f"has a <{element.tag}> without {name};", REMEDY)
    return value.strip()


def _member(element: "Element", path: Path) -> Member:
    keys = (normal_key(key) for key in element.get("wn", "").split())
    return Member(_attribute(element, "name", path), tuple(key for key in keys if "%" in key))


def _role(element: "Element", path: Path) -> Role:
    return Role(_attribute(element, "type", path), _restrictions(element.find("SELRESTRS")))


def _restrictions(element: "Element | None") -> tuple[str, ...]:
    if element is None:
        return ()
    own = [f"{each.get('Value', '')}{each.get('type', '')}" for each in element.findall("*[@type]")]
    nested = [part for each in element.findall("SELRESTRS") for part in _restrictions(each)]
    parts = [*own, *nested]
    return ("|".join(parts),) if element.get("logic") == "or" and parts else tuple(parts)


def _frame(element: "Element", path: Path) -> Frame:
    description = element.find("DESCRIPTION")
    pattern = _attribute(description, "primary", path) if description is not None else ""
    example = " ".join((element.findtext("EXAMPLES/EXAMPLE") or "").split())
    return Frame(
        pattern,
        example,
        tuple(_phrase(each) for each in element.findall("SYNTAX/*")),
        tuple(_predicate(each, path) for each in element.findall("SEMANTICS/PRED")),
    )


def _phrase(element: "Element") -> Phrase:
    stated = " ".join(element.get("value", "").split())
    return Phrase(element.tag, stated or "&".join(_restrictions(element.find("SELRESTRS"))))


def _predicate(element: "Element", path: Path) -> Predicate:
    arguments = (_attribute(each, "value", path) for each in element.findall("ARGS/ARG"))
    name = _attribute(element, "value", path)
    return Predicate(name, tuple(arguments), holds=element.get("bool") != "!")
