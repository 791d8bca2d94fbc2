"""What a segment says in plain English, by itself, as it is announced."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

from capar import __version__
from capar.model.capture import Capture
from capar.model.facts import Fact, Moving, OfAgent, Touching
from capar.model.observation import Observation, ObservedLink, Segment
from capar.model.par import ComplexPar
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from capar_rules.engine.profiles import Profile
from extractors.bodies.bodies import observed_object
from kb.language.describe import describe


class Teller:
    """Says what segments say, one at a time.

    Args:
        rig: Bodies and agents.
        rules: The rule base, whose files say what primitives are called.
    """

    def __init__(self, rig: Capture, rules: Profile) -> None:
        self._rig = rig
        self._words = primitive_words(primitive_files(rules.added))
        self._objects = tuple(observed_object(each) for each in rig.objects)

    def sentence(self, segment: Segment, facts: Iterable[Fact]) -> str:
        """What was done in a segment; empty where nothing was touched.

        Args:
            segment: The segment.
            facts: Contacts and motions of some time before it.
        """
        if not segment.objects:
            return ""
        told = tuple(each for each in facts if isinstance(each, Touching | Moving | OfAgent))
        return describe(self._observation(segment, told), words=self._words)

    def _observation(self, segment: Segment, facts: Sequence[Fact]) -> Observation:
        sensor = self._rig.sensor(segment.ee)
        owner = self._rig.agent_of(sensor)
        agent = next(each for each in self._rig.agents if each.name == owner)
        own = replace(segment, index=0)
        return Observation(
            capture=self._rig.name,
            profile="",
            rules="",
            version=__version__,
            agent=agent,
            duration_s=segment.end_s,
            rate_hz=1.0,
            frames=segment.last + 1,
            objects=self._objects,
            links=(ObservedLink(segment.ee, sensor.end_effector, sensor.side, (own,)),),
            facts=tuple(facts),
            upars=(),
            ipars=(),
            complex_par=ComplexPar("", (), segment.end_s, (), None, ()),
            locations=(),
            styles=(),
            sources=(),
            notices=(),
        )
