"""The names that a claim may use: with an unknown name it could never be true."""

import re
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import cache

from capar.model.errors import CaparError, UnknownNameError
from capar.model.facts import LookingAt
from capar.model.observation import BOTH, Observation
from capar.model.par import UNKNOWN
from capar_rules.authoring.user_primitives import rules_of
from capar_rules.engine.profiles import Profile, profile

STEP = re.compile(r"([A-Z]\w*)(?:\(([^()]*)\))?")
"""A step of a claim, such as ``MoveObjTo(mug, head)``: its name, then its objects."""


class ClaimError(CaparError):
    """A claim that cannot be read, or that names what is not there."""


class UnknownInClaimError(ClaimError, UnknownNameError):
    """A name in a claim that nothing here bears."""


@dataclass(frozen=True, slots=True)
class Names:
    """The names that exist in one capture, under one rule base."""

    capture: str
    primitives: frozenset[str]
    ees: frozenset[str]
    """End-effectors that act."""

    kinds: frozenset[str]
    """Their general types."""

    objects: frozenset[str]
    sensors: frozenset[str]
    """Those with a line of sight."""

    def ee(self, name: str) -> str:
        """The name, if an end-effector of that name acts.

        Raises:
            UnknownInClaimError: None does; so too where another kind of name is wrong, below.
        """
        return self._one("acting end-effector", name, self.ees)

    def object(self, name: str) -> str:
        """The name, if an object has it."""
        return self._one("object", name, self.objects)

    def body(self, name: str) -> str:
        """The name, if an object or an end-effector has it."""
        return self._one("body", name, self.objects | self.ees)

    def sensor(self, name: str) -> str:
        """The name, if a sensor with a line of sight has it."""
        return self._one("sensor that looks", name, self.sensors)

    def pair(self, text: str) -> str:
        """``both hands`` or ``both feet``, if any of that kind acts."""
        kinds = {f"both {several}": kind for kind, several in BOTH.items()}
        known = [each for each, kind in kinds.items() if kind in self.kinds]
        return self._one("pair of acting end-effectors", text, known)

    def step(self, text: str) -> str:
        """The text, if it is a step whose primitive and objects there are."""
        name, objects = parts(text)
        self._one("primitive", name, self.primitives)
        for thing in objects or ():
            if thing != "_":
                self._one("object", thing, self.objects | self.ees)
        return text

    def _one(self, kind: str, name: str, known: Collection[str]) -> str:
        if name not in known:
            raise UnknownInClaimError(kind, name, known, where=self.capture)
        return name


def parts(step: str) -> tuple[str, tuple[str, ...] | None]:
    """The name of a step and its objects; None where it says nothing of objects.

    Raises:
        ClaimError: The text is no step.
    """
    found = STEP.fullmatch(step)
    if found is None:
        raise ClaimError(f"{step!r} is no step such as MoveObjTo(mug, head)")
    if found[2] is None:
        return found[1], None
    return found[1], tuple(each.strip() for each in found[2].split(",") if each.strip())


def names_of(
    seen: Observation, *, rules: Profile | None = None, sensors: Iterable[str] = ()
) -> Names:
    """The names that claims about an observed capture may use.

    Args:
        seen: The observation.
        rules: The rule base that it was observed with; None for what ships of its profile, and the
            names that its segments bear.
        sensors: Those with a line of sight, beside heads that act and those that are seen to look.
    """
    segments = {each for one in seen.segments for each in (one.name, *one.general)}
    heads = {each.ee for each in seen.links if each.kind == "head"}
    looking = {each.sensor for each in seen.facts if isinstance(each, LookingAt)}
    return Names(
        capture=seen.capture,
        primitives=_primitives(rules or profile(seen.profile)) | segments | {UNKNOWN},
        ees=frozenset(each.ee for each in seen.links),
        kinds=frozenset(each.kind for each in seen.links),
        objects=frozenset(each.name for each in seen.objects),
        sensors=frozenset(looking | heads | set(sensors)),
    )


@cache
def _primitives(rules: Profile) -> frozenset[str]:
    return frozenset(each.name for each in rules_of(rules))
