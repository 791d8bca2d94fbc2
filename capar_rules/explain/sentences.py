"""What atoms say: sentences and quantities from comments of the rule files, filled in."""

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cache, cached_property
from pathlib import Path

from capar.model.body_names import is_plural
from capar.model.facts import ALL_FACT_KINDS, Fact
from capar_rules.borders.numbering import Tick
from capar_rules.engine.profiles import Profile
from capar_rules.engine.solver import rule_file
from capar_rules.engine.syntax import Signature, Statement, parse, split_arguments

_TEMPLATE = re.compile(r"%!(!?)\s*(not )?(\w+)/(\d+)(?: (\w+))?:\s*(.+)")
_QUANTITIES = re.compile(r"%=\s*(\w+)/(\d+)(?: (\w+))?:\s*(.+)")
_SEGMENT = re.compile(r"seg\((\w+),(\d+)\)")
_SUBJECT = "".join(f"(?<!\\b{word} )" for word in ("of", "with", "to", "on", "by", "from"))
_PLURAL = {"was": "were", "is": "are", "has": "have", "does": "do"}

_KINDS: tuple[type[Fact], ...] = (*ALL_FACT_KINDS, Tick)
_FIELDS = {
    (each.predicate, len(fields(each))): tuple(field.name for field in fields(each))
    for each in _KINDS
}


@dataclass(frozen=True, slots=True)
class Template:
    """The sentence of a predicate."""

    text: str
    leading: bool
    """Whether it states a condition that explanations list."""


Asked = tuple[str, tuple[str, ...]]
"""A quantity of ``quantities.py``, and which arguments of the atom it is about."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """A quantity that is compared with a limit."""

    asked: Asked
    against: Asked | None
    """The quantity that it is compared with, if that is no constant."""

    relation: str = ""
    """How it is to its limit where extractors compared it, and no rule."""


@dataclass(frozen=True)
class Scene:
    """When the ticks and segments of an answer are, and what bodies are called."""

    rate_hz: float
    frames: Mapping[str, Sequence[int]]
    """Frames of the ticks, by end-effector."""

    ends: Mapping[tuple[str, int], int] = field(default_factory=dict)
    """The tick where the segment ends that begins at a tick."""

    names: Mapping[str, str] = field(default_factory=dict)
    """What bodies are called where that is not their name."""

    objects: Mapping[str, Sequence[str]] = field(default_factory=dict)
    """The objects of each segment in the order of its features, by the segment's term."""

    own: str = ""
    """The term of the segment that is explained."""

    def called(self, name: str) -> str:
        """A body as sentences call it."""
        return self.names.get(name, name.replace("_", " "))

    @cached_property
    def plurals(self) -> tuple[str, ...]:
        """The names of objects that are plurals."""
        objects = dict.fromkeys(self.called(one) for many in self.objects.values() for one in many)
        return tuple(each for each in objects if is_plural(each))

    def at(self, frame: int) -> str:
        """A frame as a time."""
        return f"{frame / self.rate_hz:.2f} s"

    def span(self, term: str) -> tuple[int, int] | None:
        """First and last frame of the segment that a term names."""
        found = _SEGMENT.fullmatch(term)
        last = self.ends.get((found[1], int(found[2]))) if found else None
        if found is None or last is None:
            return None
        return self.frames[found[1]][int(found[2])], self.frames[found[1]][last]

    def object_of(self, term: str) -> str:
        """The object that a segment is about."""
        return next(iter(self.objects.get(term, ())), "object")

    def frames_of(self, predicate: str, arguments: Sequence[str]) -> tuple[int, int] | None:
        """First and last frame of a measurement, a tick or a segment; None for other atoms."""
        names = _FIELDS.get((predicate, len(arguments)), ())
        named = dict(zip(names, arguments, strict=False))
        if "first" in named:
            return int(named["first"]), int(named.get("last", named["first"]))
        if "frame" in named:
            return int(named["frame"]), int(named["frame"])
        return next((span for one in arguments if (span := self.span(one)) is not None), None)


class Argument:
    """An argument of an atom, formatted as a name, a time or a number."""

    def __init__(self, text: str, every: Sequence[str], scene: Scene, times: list[int]) -> None:
        self.text, self.every, self.scene, self.times = text, every, scene, times

    def __format__(self, form: str) -> str:
        scene, text = self.scene, self.text
        if form in ("start", "end", "segment", "border"):
            return self._border(form)
        if form in ("pairs", "things"):
            return self._features(form)
        told: Mapping[str, Callable[[], str]] = {
            "frame": lambda: self._at(int(text)),
            "tick": lambda: self._at(scene.frames[self.every[0]][int(text)]),
            "milli": lambda: f"{int(text) / 1000.0:.2f}",
            "hand": lambda: scene.called(_hand(text)),
            "object": lambda: scene.called(scene.object_of(text)),
            "listed": lambda: listed(
                [f"the {scene.called(one)}" for one in (_hand(text), *scene.objects.get(text, ()))]
            ),
            "": lambda: "something" if text == "_" else _named(text, scene),
        }
        return told[form]()

    def _at(self, frame: int) -> str:
        self.times.append(frame)
        return self.scene.at(frame)

    def _border(self, form: str) -> str:
        span = self.scene.span(self.every[0] if form == "border" else self.text)
        side = self.text if form == "border" else form
        if span is None or side not in ("start", "end", "segment"):
            return f"its {side}"
        if side == "segment":
            return f"{self._at(span[0])} and {self._at(span[1])}"
        return self._at(span[side == "end"])

    def _features(self, form: str) -> str:
        """The bodies for which a string of features has a one."""
        pairs = pairs_of(self.every[0], self.scene.objects.get(self.every[0], ()), self.text, form)
        ones = [pair for pair, bit in zip(pairs, self.text, strict=False) if bit == "1"]
        return ", ".join(" with ".join(map(self.scene.called, pair)) for pair in ones) or "nothing"


def pairs_of(segment: str, objects: Sequence[str], string: str, form: str) -> list[tuple[str, ...]]:
    """The bodies that each place of a string of features is about.

    Args:
        segment: The term of the segment.
        objects: Its objects, the one that it is about first.
        string: The string, of which the length tells the number of objects.
        form: ``things`` for strings of single objects, ``pairs`` for those of contacts.
    """
    count = len(string) if form == "things" else (len(string) + 1) // 2
    known = [*objects[:count], *["something else"] * (count - len(objects))]
    if form == "things":
        return [(one,) for one in known]
    return [*((_hand(segment), one) for one in known), *((known[0], one) for one in known[1:])]


def _hand(segment: str) -> str:
    return segment.removeprefix("seg(").split(",")[0]


def _named(text: str, scene: Scene) -> str:
    """A body; of a pool, each."""
    if text.startswith("(") and ";" in text:
        return " or ".join(_named(each.strip(), scene) for each in text[1:-1].split(";"))
    return scene.called(text.strip('"'))


class Sentences:
    """The templates of a rule base."""

    def __init__(self, statements: Iterable[Statement]) -> None:
        self.templates: dict[tuple[bool, str, int, str], Template] = {}
        """By whether it is of the absence, predicate, arity, and one of the arguments or none."""

        self.comparisons: dict[tuple[str, int, str], tuple[Comparison | None, ...]] = {}
        for each in statements:
            for line in each.text.splitlines() if each.kind == "comment" else ():
                if found := _TEMPLATE.match(line.strip()):
                    leading, absent, name, arity, kind, text = found.groups()
                    key = bool(absent), name, int(arity), kind or ""
                    self.templates[key] = Template(text, bool(leading))
                elif found := _QUANTITIES.match(line.strip()):
                    name, arity, kind, text = found.groups()
                    told = tuple(_comparison(one) for one in text.split(","))
                    self.comparisons[name, int(arity), kind or ""] = told
        self.described = {(absent, name, arity) for absent, name, arity, _ in self.templates}
        self.compared = {(name, arity) for name, arity, _ in self.comparisons}

    def template(
        self, predicate: str, arguments: Sequence[str], *, absent: bool = False
    ) -> Template | None:
        """The template for an atom; one for a certain argument precedes the general one."""
        key = absent, predicate, len(arguments)
        kinds = (self.templates.get((*key, each)) for each in (*arguments, ""))
        return next((found for found in kinds if found is not None), None)

    def quantities(self, predicate: str, arguments: Sequence[str]) -> tuple[Comparison | None, ...]:
        """What the rules for an atom compare, or what was measured for it."""
        for each in (*arguments, ""):
            if found := self.comparisons.get((predicate, len(arguments), each)):
                return found
        return ()

    def describes(self, signature: Signature, *, absent: bool = False) -> bool:
        """Whether there is a sentence for such an atom, or for its absence."""
        return (False, *signature) in self.described or (absent, *signature) in self.described

    def say(
        self, predicate: str, arguments: Sequence[str], scene: Scene, *, absent: bool = False
    ) -> tuple[str, tuple[int, ...]]:
        """The sentence for an atom, empty if it has no template, and the frames that it names."""
        template = self.template(predicate, arguments, absent=absent)
        negated = template is None and absent
        if negated:
            template = self.template(predicate, arguments)
        if template is None:
            return "", ()
        times: list[int] = []
        values = [Argument(each, arguments, scene, times) for each in arguments]
        text = template.text.format(*values)
        for each in scene.plurals:
            text = re.sub(
                rf"{_SUBJECT}\b(the {each}) (was|is|has|does)\b",
                lambda found: f"{found[1]} {_PLURAL[found[2]]}",
                text,
            )
        text = text.replace("the something", "something")
        return f"it is not so that {text}" if negated else text, tuple(times)


@dataclass(frozen=True, eq=False)
class RuleBase:
    """The rules of a profile with the templates of their comments."""

    sentences: Sentences
    statements: tuple[Statement, ...]

    @cached_property
    def rules(self) -> Mapping[Signature, Sequence[Statement]]:
        """The rules for each predicate that have one head."""
        found: dict[Signature, list[Statement]] = defaultdict(list)
        for each in self.statements:
            if len(each.heads) == 1:
                found[each.heads[0].signature].append(each)
        return found


def rule_base(profile: Profile) -> RuleBase:
    """The rules of a profile, parsed once."""
    return _rule_base(profile.files, profile.fingerprint)


@cache
def _rule_base(files: tuple[Path, ...], fingerprint: str) -> RuleBase:
    statements = parse((*files, rule_file("explain/explaining.lp")))
    return RuleBase(Sentences(statements), statements)


def _comparison(text: str) -> Comparison | None:
    """``height 1 ~ aside 1``, or ``@distance 1 2 <=``; None for ``-``."""
    first, _, second = (part.strip() for part in text.partition("~"))
    if first == "-":
        return None
    relation = ""
    if first.startswith("@"):
        first, relation = first[1:].rsplit(maxsplit=1)
    (name, *bodies), other = first.split(), second.split()
    against = (other[0], tuple(other[1:])) if other else None
    return Comparison((name, tuple(bodies)), against, relation)


def bodies_of(asked: Asked, arguments: Sequence[str], scene: Scene) -> tuple[str, ...]:
    """The bodies that a quantity of an atom is about."""
    segment = next((each for each in arguments if each.startswith("seg(")), scene.own)
    own = {"hand": _hand(segment), "object": scene.object_of(segment)}
    return tuple(own.get(each) or arguments[int(each)] for each in asked[1])


def parsed(atom: str) -> tuple[str, list[str]]:
    """The predicate of an atom, and its arguments without quotation marks."""
    arguments = split_arguments(atom) if "(" in atom else []
    return atom.partition("(")[0], [each.strip('"') for each in arguments]


def listed(texts: Sequence[str]) -> str:
    """Texts as one list."""
    return " and ".join([", ".join(texts[:-1]), texts[-1]] if texts[1:] else texts)
