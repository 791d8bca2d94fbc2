"""What every kind of observed fact declares, once, where it is defined."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cache
from inspect import get_annotations
from operator import attrgetter
from types import MappingProxyType, ModuleType
from typing import Any, ClassVar, Self, cast

from capar.model.atoms import Fact
from capar.model.errors import FactError


class Span(Enum):
    """When the facts of a kind hold."""

    ALWAYS = ()
    INSTANT = ("frame",)
    INTERVAL = ("first", "last")


@dataclass(frozen=True, slots=True, kw_only=True)
class Declaration:
    """What one kind of fact says of itself; what others need to know of it is derived from this."""

    about: str | None
    """The field that names the body which the fact is about; None where it is about no body."""

    span: "Span | type[Observed]"
    """When it holds. A kind of facts instead: throughout one of those intervals, which has the
    same bodies and the same first frame."""

    border: bool | frozenset[str]
    """Whether segments of the body that it is about, and of end-effectors that touch this body
    meanwhile, may begin or end where the fact begins or ends, so that places are measured there;
    a set: only those of its stretches."""

    has_sentence: bool
    """Whether an explanation has a sentence for it, in ``capar_rules/explain/sentences.lp``."""

    stretch: str = ""
    """Under which name rules find the ticks in it (``spans/6``, ``encloses/6``); it may contain
    fields in braces. Empty: rules do not join it by ticks."""

    others: tuple[str, ...] = ()
    """The fields that name the other body of such a stretch, one each; none: the body itself."""

    negated: str = ""
    """What a measured interval is taken for that is contradicted as flicker, such as ``apart``;
    empty where flicker is not resolved."""

    rdf: tuple[str, ...]
    """The class in the ontology, and the property of each argument. Of a sampled kind: of each
    argument that names something, and of the rows of the others, each row led by its frame."""

    powers: Mapping[str, int] = field(default_factory=lambda: MappingProxyType({}))
    """The power of ten by which an argument becomes a number of SI units in RDF, by its field."""

    @property
    def sampled(self) -> bool:
        """Whether its facts are samples of a quantity at frames, which RDF keeps as one row."""
        return self.span is Span.INSTANT and not self.border


class Observed(Fact):
    """A fact that an observation rests on; its class carries a declaration."""

    __slots__ = ()

    declaration: ClassVar[Declaration]

    def __init_subclass__(cls, **options: Any) -> None:
        """Check the declaration against the fields.

        Raises:
            FactError: There is none, or it does not fit the fields.
        """
        super().__init_subclass__(**options)
        declared = cls.__dict__.get("declaration")
        if declared is None:
            raise FactError(f"{cls.__name__} lacks a declaration: what it is about, its span ...")
        _check(cls.__name__, declared, get_annotations(cls))

    def subject(self) -> str:
        """The body that the fact is about; empty where it is about none."""
        about = self.declaration.about
        return "" if about is None else str(getattr(self, about))

    def ends(self) -> tuple[int, ...]:
        """The frames that the fact itself states: an instant, or the first and the last frame."""
        return _ends_of(cast(Any, type(self)))(self)

    def other_bodies(self) -> tuple[str, ...]:
        """The other body of each stretch that the fact states; at least the body itself."""
        others = self.declaration.others
        return tuple(str(getattr(self, each)) for each in others) or (self.subject(),)

    def stretch(self) -> str:
        """The name under which rules find the ticks in it; empty where they do not."""
        pattern = self.declaration.stretch
        return _BRACES.sub(lambda found: str(getattr(self, found[1])), pattern)

    def is_border(self) -> bool:
        """Whether a segment may begin or end where it does."""
        border = self.declaration.border
        return border if isinstance(border, bool) else self.stretch() in border

    def name(self, kind: "type[Observed]") -> tuple[object, ...]:
        """The name of an interval of a kind: of this one, or of the one that its span is."""
        return kind, *(getattr(self, each) for each in _naming_fields(cast(Any, kind)))

    def between(self, first: int, last: int) -> Self:
        """The same fact of another interval."""
        return replace(cast(Any, self), first=first, last=last)


@cache
def _ends_of(kind: type[Observed]) -> Callable[[Observed], tuple[int, ...]]:
    """What reads the frames that facts of a kind state; they are read very often."""
    span = kind.declaration.span
    names = span.value if isinstance(span, Span) else ("first",)
    if len(names) > 1:
        return attrgetter(*names)
    return lambda fact: tuple(getattr(fact, name) for name in names)


_BRACES = re.compile(r"\{(\w+)\}")


@cache
def _naming_fields(kind: Any) -> tuple[str, ...]:
    """The fields by which other facts name an interval of a kind."""
    return tuple(each for each in get_annotations(kind) if each != "last")


def _check(name: str, declared: Declaration, fields: dict[str, type]) -> None:
    span = declared.span
    braces = _BRACES.findall(declared.stretch)
    frames = span.value if isinstance(span, Span) else _naming_fields(cast(Any, span))
    about = () if declared.about is None else (declared.about,)
    needed = (*about, *frames, *declared.others, *braces)
    missing = [each for each in needed if each not in fields]
    if missing:
        raise FactError(f"{name} declares the fields {missing}, but has {list(fields)}")
    _check_rdf(name, declared, fields)
    if declared.negated and span is not Span.INTERVAL:
        raise FactError(f"{name} cannot flicker: it is no interval")


def _check_rdf(name: str, declared: Declaration, fields: dict[str, type]) -> None:
    named = [each for each, of in fields.items() if of is str]
    terms = len(named) + 1 if declared.sampled else len(fields)
    if len(declared.rdf) != terms + 1:
        raise FactError(f"{name} declares {declared.rdf}: expected a class and {terms} properties")
    if strange := [each for each in declared.powers if fields.get(each) is not int]:
        raise FactError(f"{name} declares powers of {strange}, which are no whole numbers of it")


def kinds_of(module: ModuleType) -> tuple[type[Observed], ...]:
    """The kinds of facts that a module defines, in their order."""
    return tuple(
        each
        for each in vars(module).values()
        if isinstance(each, type)
        and issubclass(each, Observed)
        and each.__module__ == module.__name__
    )
