"""What every kind of fact is and declares: a typed value that is an atom of the rules."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from enum import Enum
from functools import cache
from inspect import get_annotations
from itertools import groupby
from operator import attrgetter
from types import MappingProxyType, ModuleType
from typing import Any, ClassVar, Self, cast, get_type_hints

import clingo

from capar.model.capture import NAME
from capar.model.errors import FactError

LARGEST = 2**31 - 1
"""The largest integer of the solver, which wraps silently beyond."""


@dataclass(frozen=True, slots=True, order=True)
class Fact:
    """A relation with arguments; the predicate is a class's, the arguments are an instance's.

    Frames are numbered from zero; intervals are closed, [first, last].
    """

    predicate: ClassVar[str]

    def symbol(self) -> clingo.Symbol:
        """The fact as the solver's own value.

        Raises:
            FactError: An integer that the solver cannot hold.
        """
        values = (getattr(self, name) for name in arguments(cast(Any, type(self))))
        return clingo.Function(self.predicate, [_symbol(each) for each in values])

    @classmethod
    def from_symbol(cls, symbol: clingo.Symbol) -> Self:
        """The fact that a solver's value states.

        Raises:
            FactError: Another predicate, another number of arguments, or another type.
        """
        kinds: tuple[type, ...] = _kinds(cast(Any, cls))
        if symbol.name != cls.predicate or len(symbol.arguments) != len(kinds):
            raise FactError(f"{symbol} is no {cls.predicate}/{len(kinds)}")
        return cls(
            *(_value(each, kind) for each, kind in zip(symbol.arguments, kinds, strict=True))
        )

    def __str__(self) -> str:
        """The fact as a line of a logic program, without its full stop.

        Raises:
            FactError: An integer that the solver cannot hold.
        """
        values = [getattr(self, name) for name in arguments(cast(Any, type(self)))]
        return f"{self.predicate}({','.join(map(_text, values))})" if values else self.predicate


def _symbol(value: Any) -> clingo.Symbol:
    if isinstance(value, int):
        return clingo.Number(_checked_int32(value))
    return clingo.Function(value) if NAME.fullmatch(value) else clingo.String(value)


def _text(value: int | str) -> str:
    """The argument as the solver writes it, some ten times faster than by way of its symbol."""
    return str(_checked_int32(value)) if isinstance(value, int) else _word(value)


@cache
def _word(value: str) -> str:
    return str(_symbol(value))


def _checked_int32(value: int) -> int:
    if abs(value) > LARGEST:
        raise FactError(f"{value} does not fit the solver's 32 bits")
    return value


def _value(symbol: clingo.Symbol, kind: type) -> Any:
    if symbol.type is clingo.SymbolType.Number and kind is int:
        return symbol.number
    if symbol.type is clingo.SymbolType.String and kind is str:
        return symbol.string
    if symbol.type is clingo.SymbolType.Function and kind is str and not symbol.arguments:
        return symbol.name
    raise FactError(f"{symbol} is no {kind.__name__}")


@cache
def arguments(cls: Any) -> tuple[str, ...]:
    """The names of the arguments of a kind of fact, in their order."""
    return tuple(each.name for each in fields(cls))


@cache
def _kinds(cls: Any) -> tuple[type, ...]:
    hints = get_type_hints(cls)
    return tuple(hints[each.name] for each in fields(cls))


def signatures(facts: Iterable[Fact]) -> frozenset[tuple[str, int]]:
    """The predicates of the facts, each with its number of arguments."""
    kinds: set[Any] = {type(fact) for fact in facts}
    return frozenset((kind.predicate, len(arguments(kind))) for kind in kinds)


def program(facts: "tuple[Fact, ...]") -> str:
    """The facts as a logic program, one a line, in their order.

    Raises:
        FactError: An integer that the solver cannot hold.
    """
    groups = (_lines(kind, tuple(group)) for kind, group in groupby(facts, type))
    return "".join(line for lines in groups for line in lines)


def _lines(kind: Any, facts: "tuple[Fact, ...]") -> Iterator[str]:
    """Facts of one kind as lines: by columns, in a third of the time of one after another."""
    columns = [
        _column([getattr(fact, name) for fact in facts], argument)
        for name, argument in zip(arguments(kind), _kinds(kind), strict=True)
    ]
    if not columns:
        return iter([f"{kind.predicate}.\n"] * len(facts))
    line = f"{kind.predicate}({','.join(['%s'] * len(columns))}).\n"
    return map(line.__mod__, zip(*columns, strict=True))


def _column(values: list[Any], kind: type) -> Iterable[int | str]:
    """The values of one argument as the solver writes them."""
    if kind is not int:
        return map(_word, values)
    _checked_int32(max(values, key=abs))
    return values


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
