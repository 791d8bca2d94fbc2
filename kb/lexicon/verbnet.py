"""VerbNet 3.x as values, read from the XML files of a user's copy."""

import re
from collections import Counter
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
        """The event in which it holds: ``e1``, ``ë2`` or ``E``; or empty."""
        return next((each for each in self.arguments if re.fullmatch(r"[eëE]\d*", each)), "")

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


REMEDY = "VerbNet 3.x holds one class a file, with <VNCLASS ID=...> at its top."


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
    names = Counter(each.id for top in classes for each in top.family)
    (name, times), *_ = names.most_common(1)
    if times > 1:
        raise FileError(folder, f"has class {name} twice;", "keep one copy of each class.")
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


def key_rate(classes: Iterable[VerbClass], words: WordNet) -> tuple[int, int]:
    """How many WordNet keys the classes' members have, and how many of them that WordNet has."""
    family = [each for top in classes for each in top.family]
    keys = [key for each in family for member in each.members for key in member.keys]
    return len(keys), sum(key in words for key in keys)


def _verb_class(element: "Element", parent: str, path: Path) -> VerbClass:
    name = _attribute(element, "ID", path)
    members = []
    for each in element.findall("MEMBERS/MEMBER"):
        keys = (normal_key(key) for key in each.get("wn", "").split())
        members.append(Member(_attribute(each, "name", path), tuple(k for k in keys if "%" in k)))
    return VerbClass(
        name,
        parent,
        tuple(members),
        tuple(
            Role(_attribute(each, "type", path), _restrictions(each.find("SELRESTRS")))
            for each in element.findall("THEMROLES/THEMROLE")
        ),
        tuple(_frame(each, path) for each in element.findall("FRAMES/FRAME")),
        tuple(_verb_class(each, name, path) for each in element.findall("SUBCLASSES/VNSUBCLASS")),
    )


def _attribute(element: "Element", name: str, path: Path) -> str:
    value = element.get(name)
    if not value:
        raise FileError(path, f"has a <{element.tag}> without {name};", REMEDY)
    return value.strip()


def _restrictions(element: "Element | None") -> tuple[str, ...]:
    if element is None:
        return ()
    own = [f"{each.get('Value', '')}{each.get('type', '')}" for each in element.findall("*[@type]")]
    nested = [part for each in element.findall("SELRESTRS") for part in _restrictions(each)]
    parts = [*own, *nested]
    return ("|".join(parts),) if element.get("logic") == "or" and parts else tuple(parts)


def _frame(element: "Element", path: Path) -> Frame:
    description = element.find("DESCRIPTION")
    syntax = []
    for each in element.findall("SYNTAX/*"):
        stated = " ".join(each.get("value", "").split())
        restrictions = "&".join(_restrictions(each.find("SELRESTRS")))
        syntax.append(Phrase(each.tag, stated or restrictions))
    return Frame(
        _attribute(description, "primary", path) if description is not None else "",
        " ".join((element.findtext("EXAMPLES/EXAMPLE") or "").split()),
        tuple(syntax),
        tuple(
            Predicate(
                _attribute(each, "value", path),
                tuple(_attribute(one, "value", path) for one in each.findall("ARGS/ARG")),
                holds=each.get("bool") != "!",
            )
            for each in element.findall("SEMANTICS/PRED")
        ),
    )
