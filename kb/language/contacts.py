"""How a sentence may put what a segment did: where a thing stood, or that it was there before.

This is wording only. It chooses among ways to say an action that the rules have named ("put it
down", "put it back"), reads measured contacts alone, and names, splits or drops no segment.
"""

from collections.abc import Iterable

from capar.model.facts import Link, Moving, OfAgent, Touching
from capar.model.observation import Observation, Segment
from kb.lexicon.english import the_agent


class Scene:
    """Measured contacts of an observation, asked for the wording of its sentences."""

    def __init__(self, observation: Observation) -> None:
        effectors = {link.ee for link in observation.links}
        effectors |= {fact.ee for fact in observation.facts if isinstance(fact, Link)}
        touching = [fact for fact in observation.facts if isinstance(fact, Touching)]
        self._hands = [each for each in touching if each.body in effectors]
        self._pairs = [each for each in touching if each.body not in effectors]
        self._moving = [fact for fact in observation.facts if isinstance(fact, Moving)]
        self._tags = {thing.name: thing.tag for thing in observation.objects}
        owners = [fact for fact in observation.facts if isinstance(fact, OfAgent)]
        self._owners = {each.body: each.agent for each in owners}
        self._kinds = {each.name: each.kind for each in (observation.agent, *observation.others)}

    def is_self(self, name: str) -> bool:
        """Whether an object is of the agent's own body."""
        return self._tags.get(name) == "self"

    def rests_on(self, thing: str, support: str) -> bool:
        """Whether the thing lay still on the support at some time while no hand touched it."""
        if self.is_self(support):
            return False
        return any(self._free(each, thing) for each in self._between(thing, support))

    def was_there(self, segment: Segment, thing: str, goal: str) -> bool:
        """Whether the thing touched the goal before, and left it."""
        return any(
            each.first <= segment.first and each.last < segment.last
            for each in self._between(thing, goal)
        )

    def taker(self, segment: Segment) -> str:
        """The one other agent who has the dominant object when a segment begins, and after it.

        Said as a noun phrase; empty where there is none, or several.
        """
        own = self._owners.get(segment.ee)
        found = {
            self._owners.get(each.body, own)
            for each in self._hands
            if each.other in segment.objects[:1] and each.first <= segment.first < each.last
        }
        names = [each for each in found if each and each != own]
        return the_agent(names[0], self._kinds.get(names[0], "")) if len(names) == 1 else ""

    def _between(self, thing: str, other: str) -> Iterable[Touching]:
        return (each for each in self._pairs if {each.body, each.other} == {thing, other})

    def _free(self, contact: Touching, thing: str) -> bool:
        """Whether frames of a contact remain in which the thing is neither touched nor moved."""
        hands = [(each.first, each.last) for each in self._hands if each.other == thing]
        moves = [(each.first, each.last) for each in self._moving if each.object == thing]
        frame = contact.first
        for first, last in sorted(hands + moves):
            if first > frame:
                return True
            frame = max(frame, last + 1)
            if frame > contact.last:
                return False
        return frame <= contact.last
