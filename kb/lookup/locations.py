"""Constraint locations and styles by kind of object, agent, action and side (thesis 4.4.2)."""

from dataclasses import dataclass, replace

from pyoxigraph import Literal, NamedNode

from capar.model.locations import ConstraintLocation
from capar.model.par import Nlt, Style
from kb.lookup.agents import Agents
from kb.store import names
from kb.store.sparql import stored
from kb.store.statements import nlt_of, numbers, path_of
from ontology import CAPAR

OTHER = {"right": "left", "left": "right"}
"""The other side of the body."""


@dataclass(frozen=True, slots=True)
class FoundLocation:
    """A constraint location, and how it was found."""

    location: ConstraintLocation
    kind: str
    """The kind of object that it is kept with."""

    observation: str
    agent: str
    mirrored: bool
    """Whether it was observed on the other side of the body."""

    inherited: bool
    """Whether it is kept with a more general kind than was asked for."""


@dataclass(frozen=True, slots=True)
class FoundStyle:
    """A style, and in which observation it was seen."""

    style: Style
    agent: str
    observation: str


class Knowledge(Agents):
    """All lookups over a store."""

    def locations(
        self,
        kind: str,
        *,
        action: str | None = None,
        purpose: str | None = None,
        side: str | None = None,
    ) -> tuple[FoundLocation, ...]:
        """Constraint locations for a kind of object, best first.

        Those of the kind itself stand before those of more general kinds, those of the side
        before those mirrored from the other one; then by observation.
        """
        return self._locations(kind, action=action, purpose=purpose, side=side)

    def location(
        self, kind: str, *, action: str, purpose: str | None = None, side: str | None = None
    ) -> ConstraintLocation | None:
        """The best constraint location for a kind of object, mirrored if need be."""
        found = self._locations(kind, action=action, purpose=purpose, side=side, most=1)
        return found[0].location if found else None

    def _locations(
        self,
        kind: str,
        *,
        action: str | None,
        purpose: str | None,
        side: str | None,
        most: int | None = None,
    ) -> tuple[FoundLocation, ...]:
        order = self.kinds_above(kind)
        wanted = {CAPAR.actionName: action, CAPAR.purpose: purpose}
        filters = [
            f"?place {p} {Literal(word)} ." for p, word in wanted.items() if word is not None
        ]
        nodes = " ".join(str(names.shared("kind", each)) for each in order)
        nearest: dict[str, tuple[int, bool, str]] = {}
        for of, place, on in self.store.ask(
            stored("ranked_locations", kinds=nodes, filters="\n  ".join(filters))
        ).rows:
            assert isinstance(of, NamedNode) and isinstance(on, Literal)
            mirror = side not in {None, on.value}
            if mirror and OTHER.get(on.value) != side:
                continue
            word = names.last_word(of)
            rank = (order.index(word), mirror, word)
            nearest[str(place)] = min(rank, nearest.get(str(place), rank))
        best = sorted(nearest, key=lambda place: (*nearest[place][:2], place))[:most]
        if not best:
            return ()
        answer = self.store.ask(stored("locations", places=" ".join(best)))
        details = {
            str(row[0]): text[1:] for row, text in zip(answer.rows, answer.texts(), strict=True)
        }
        return tuple(_found_location(details[e], *nearest[e][1:], kind) for e in best)

    def styles(
        self,
        *,
        agent: str | None = None,
        action: str | None = None,
        purpose: str | None = None,
        ee: str | None = None,
    ) -> tuple[FoundStyle, ...]:
        """Styles that fit, by observation and in the order in which they were seen there."""
        wanted = {
            f"{CAPAR.agent}/{CAPAR.name}": agent,
            f"{CAPAR.actionName}": action,
            f"{CAPAR.purpose}": purpose,
            f"{CAPAR.ee}": ee,
        }
        filters = [f"?style {path} {Literal(word)} ." for path, word in wanted.items() if word]
        found = []
        for row in self.store.ask(stored("styles", filters="\n  ".join(filters))).texts():
            who, observation, index, name, aim, with_, velocity, points = row
            style = Style(name, aim, with_, numbers(velocity), path_of(points))
            found.append(((observation, int(index)), FoundStyle(style, who, observation)))
        return tuple(each for _, each in sorted(found, key=lambda each: each[0]))

    def style(
        self, agent: str, *, action: str, purpose: str | None = None, ee: str | None = None
    ) -> Style | None:
        """An agent's style of doing an action, from the first observation by name."""
        found = self.styles(agent=agent, action=action, purpose=purpose, ee=ee)
        return found[0].style if found else None


def _found_location(text: list[str], mirror: bool, kind: str, asked: str) -> FoundLocation:
    observation, agent, action, purpose, ee, on, frame, dominant, goal, held, at, seen, view = text
    location = ConstraintLocation(
        action=action,
        purpose=purpose,
        ee=ee,
        side=on,
        frame=int(frame),
        dominant=dominant,
        goal=goal,
        ee_nlt=_nlt(held),
        goal_nlt=_nlt(at),
        seen=seen,
        v_nlt=_nlt(view),
    )
    return FoundLocation(
        location=mirrored(location) if mirror else location,
        kind=kind,
        observation=observation,
        agent=agent,
        mirrored=mirror,
        inherited=kind != asked,
    )


def _nlt(text: str) -> Nlt | None:
    return nlt_of(text) if text else None


def mirrored(value: ConstraintLocation) -> ConstraintLocation:
    """The same constraint made with the other side of the body (thesis 4.4.2.2)."""
    return replace(
        value,
        side=OTHER.get(value.side, value.side),
        ee_nlt=value.ee_nlt and value.ee_nlt.mirrored(),
        goal_nlt=value.goal_nlt and value.goal_nlt.mirrored(),
        v_nlt=value.v_nlt and value.v_nlt.mirrored(),
    )
