"""Why a segment has its name: its derivation tree as sentences."""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from pathlib import Path

from capar.model.errors import RuleError
from capar.model.facts import Fact
from capar.model.observation import Segment
from capar.model.par import UNKNOWN
from capar_rules.borders.border_numbers import number_borders
from capar_rules.engine.profiles import Profile
from capar_rules.engine.syntax import Place, Statement, parse_text
from capar_rules.explain.briefs import Briefs
from capar_rules.explain.claims import Claim
from capar_rules.explain.clock import Clock
from capar_rules.explain.contrast.contrasts import contrasts
from capar_rules.explain.contrast.deciding_clauses import Wording
from capar_rules.explain.contrast.near_misses import more_specific, near_misses, preceding
from capar_rules.explain.contrast.neighbours import conditions_of_neighbours, generals_of
from capar_rules.explain.contrast.told_contrast import Contrast
from capar_rules.explain.derivations import Derivations, Grounds, Recorder
from capar_rules.explain.instants import corrected, frames_of
from capar_rules.explain.leading import bit
from capar_rules.explain.measured import Measured
from capar_rules.explain.measured_facts import measured_by
from capar_rules.explain.reason import Reason as Reason
from capar_rules.explain.rule_base import RuleBase as RuleBase
from capar_rules.explain.rule_base import rule_base as rule_base
from capar_rules.explain.summary import summary
from capar_rules.explain.windows import Windows

ALWAYS = (("segment", 3), ("also", 2))
TOGETHER = 16
"""Greatest number of segments whose windows are grounded together."""

KEPT = 32
"""Greatest number of recorders that are kept: each set of names that segments are explained
together by has its own."""


@dataclass(frozen=True)
class Explanation:
    """A segment's name and why it has it."""

    ee: str
    index: int
    name: str
    start_s: float
    end_s: float
    summary: str
    claims: tuple[Claim, ...]
    """The clauses of the summary, with what was measured for each."""

    reason: Reason
    names: tuple[str, ...] = ()
    """The names of which the summary speaks, the segment's own first."""


@lru_cache(maxsize=KEPT)
def recorder(base: RuleBase, names: frozenset[str]) -> Recorder:
    """The recorder of why segments have names, or, for ``Unknown`` alone, why they have none.

    What is recorded of a segment of one of the names is the same whatever the others are.
    """
    if names == {UNKNOWN}:
        return Recorder(base.statements, targets=(("parted_at", 2), ("nearest", 2), *ALWAYS))
    others = [each for each in base.statements if not _names(each) and not _overrules(each)]
    naming = [rule for name in sorted(names) for rule in _rules_of_name(base, name)]
    asked = (node for name in sorted(names) for node in conditions_of_neighbours(base, name))
    return Recorder([*others, *naming], targets=(("named", 2), *ALWAYS, *asked))


@lru_cache(maxsize=4 * KEPT)
def _rules_of_name(base: RuleBase, name: str) -> tuple[Statement, ...]:
    """The rules by which segments have one name, and what alone keeps them from others."""
    return (*_naming(base.statements, name), *near_misses(base.statements, name))


def _names(statement: Statement) -> bool:
    return any(head.signature == ("named", 2) for head in statement.heads)


def _overrules(statement: Statement) -> bool:
    return any(head.signature == ("overruled", 2) for head in statement.heads)


def _naming(statements: Sequence[Statement], name: str) -> Iterator[Statement]:
    """The rules that name segments, for one name: what specialises or precedes it overrules."""
    rule = f'named(Segment,"{name}") :- fits(Segment,"{name}"); not overruled(Segment,"{name}").'
    for each in statements:
        if _names(each):
            yield replace(parse_text(rule)[0], place=each.place)
    for other in sorted(more_specific(statements, name) | preceding(statements, name)):
        fit = f'fits(Segment,"{other}"); fits(Segment,"{name}")'
        yield from parse_text(f'overruled(Segment,"{name}") :- {fit}.')


class Explainer:
    """Explains the segments of a capture, each at a cost independent of the capture's length."""

    def __init__(
        self,
        facts: Sequence[Fact],
        *,
        profile: Profile,
        measured: Measured | None = None,
    ) -> None:
        """Index the facts of a capture.

        Args:
            facts: What the extractors measured.
            profile: The rules to explain by.
            measured: What else was measured of bodies; by default what the facts say.
        """
        self.profile = profile
        self.base = rule_base(profile)
        self.windows = Windows(facts, number_borders(facts, crossings_only=profile.crossings_only))
        self.measured = measured_by(facts, measured or Measured())
        self.corrected = corrected(facts)
        self.worlds: dict[Segment, str] = {}
        """The program of counterfactual worlds of each segment that was asked about."""

    def explain(self, segment: Segment) -> Explanation:
        """Why a segment has its name, or why it has none.

        Raises:
            RuleError: The segment does not follow from these facts and rules.
        """
        return self.explain_all([segment])[0]

    def explain_all(self, segments: Sequence[Segment]) -> tuple[Explanation, ...]:
        """The same of each of several segments, in a fraction of the time.

        Raises:
            RuleError: A segment does not follow from these facts and rules.
        """
        told: dict[tuple[str, int], Explanation] = {}
        windows = {each: self.windows_of(each.ee, self.ticks(each)) for each in segments}
        while waiting := [each for each in windows if (each.ee, each.index) not in told]:
            for group in _groups(waiting):
                for each in self._explained(group, [next(windows[one], None) for one in group]):
                    told[each.ee, each.index] = each
        return tuple(told[each.ee, each.index] for each in segments)

    def _explained(
        self, group: Sequence[Segment], windows: Sequence[tuple[Fact, ...] | None]
    ) -> Iterator[Explanation]:
        """The explanations of the segments that follow from their windows."""
        names = frozenset(each.name for each in group)
        given = [each for each in windows if each is not None]
        if len(given) < len(group):
            raise _unfounded(group[windows.index(None)])
        for segment, derived in zip(group, recorder(self.base, names).solve(given), strict=True):
            found = self._told(derived, segment)
            if found is not None:
                yield found

    def _told(self, derived: Derivations, segment: Segment) -> Explanation | None:
        """The explanation of a segment; None if it does not follow from what was derived."""
        ticks = self.ticks(segment)
        roots = list(_roots(derived, f"seg({segment.ee},{ticks[0]})", ticks, segment))
        if not roots:
            return None
        clock = self.clock(derived, f"seg({segment.ee},{ticks[0]})")
        done: dict[str, Reason] = {}
        reasons = [self._reason(derived.why(each), clock, done) for each in roots]
        briefs = Briefs(self.base.sentences, clock)
        against = self._against(segment.name, derived, reasons[0], briefs) if segment.known else ()
        fitting = {name for term, name in derived.holding("fits") if term == clock.own}
        generals = generals_of(self.base, segment.name)
        if len(generals) > 1:  # a kind of either is what it fits
            generals = [general for general in generals if general in fitting]
        return _explanation(segment, reasons, briefs, against, generals)

    def _against(
        self, name: str, derived: Derivations, top: Reason, briefs: Briefs
    ) -> tuple[Contrast, ...]:
        """The neighbouring names that the segment comes nearest to."""
        clock = briefs.clock

        @cache
        def tell(atom: str) -> list[str]:
            if atom.startswith("feature("):
                return briefs.contrasted(bit(top, atom, clock), top)
            if not derived.holds(atom):
                return []  # it was measured
            return briefs.first(self._reason(derived.why(atom), clock, {}), top)

        return contrasts(self.base, name, derived, clock, Wording(tell, briefs.tell))

    def ticks(self, segment: Segment) -> tuple[int, int]:
        """The numbers of the frames between which a segment lies.

        Raises:
            RuleError: It lies between others than these rules know.
        """
        frames = self.windows.frames.get(segment.ee, [])
        found = [bisect_left(frames, each) for each in (segment.first, segment.last)]
        if [frames[each] for each in found if each < len(frames)] != [segment.first, segment.last]:
            raise RuleError(
                f"segment {segment.index} of {segment.ee!r} does not lie between frames at which "
                "these facts change; observe the capture again"
            )
        return found[0], found[1]

    def windows_of(self, ee: str, ticks: tuple[int, int]) -> Iterator[tuple[Fact, ...]]:
        """Windows of facts of growing width; the first nearly always suffices."""
        for widen in (0, 3):
            yield self.windows.around(ee, *ticks, widen=widen)
        yield self.windows.whole()

    def clock(self, derived: Derivations, own: str = "") -> Clock:
        """When the ticks and segments of an answer are."""
        ends = {}
        for term, first, last in derived.holding("segment"):
            ends[term[4:].split(",")[0], int(first)] = int(last)
        objects = {row[0]: row[1] for row in derived.holding("dominant")}
        listed: dict[str, list[str]] = defaultdict(list)
        for term, _, name in sorted(derived.holding("object_at"), key=lambda row: int(row[1])):
            listed[term].append(name)
        met: dict[tuple[str, str, str], list[str]] = defaultdict(list)
        for term, side, body, other, _ in derived.holding("meets"):
            met[term, side, body].append(other)
        windows = self.windows
        strokes: dict[str, list[int]] = defaultdict(list)
        for term, frame in derived.holding("stroke_ends"):
            strokes[term].append(int(frame))
        measured = self.measured
        return Clock(
            windows.rate, windows.frames, ends, measured, objects, listed, met, strokes, own
        )

    def _reason(self, grounds: Grounds, clock: Clock, done: dict[str, Reason]) -> Reason:
        if grounds.atom in done:
            return done[grounds.atom]
        told = grounds.predicate, grounds.arguments
        mood = self._mood(grounds)
        template = self.base.sentences.template(*told, mood=mood)
        done[grounds.atom] = found = Reason(
            self.base.sentences.tell(*told, clock, mood=mood),
            grounds.atom,
            _where(grounds.rule),
            None if grounds.absent else frames_of(*told, clock),
            template is not None and template.leading,
            tuple(self._reason(each, clock, done) for each in grounds.because),
        )
        return found

    def _mood(self, grounds: Grounds) -> str:
        """Which template describes an atom: negated, mended (partly doubted) or plain."""
        if grounds.absent:
            return "not"
        doubted = any(each.predicate == "doubted" for each in grounds.because)
        return "mended" if doubted or grounds.atom in self.corrected else ""


def _groups(segments: Sequence[Segment]) -> Iterator[Sequence[Segment]]:
    """Segments to derive together, those without a name apart from the others."""
    for known in (True, False):
        alike = [each for each in segments if each.known == known]
        for start in range(0, len(alike), TOGETHER):
            yield alike[start : start + TOGETHER]


def _unfounded(segment: Segment) -> RuleError:
    return RuleError(
        f"segment {segment.index} of {segment.ee!r} is no {segment.name} by these rules; "
        "observe the capture again"
    )


def _roots(
    derived: Derivations, term: str, ticks: tuple[int, int], segment: Segment
) -> Iterator[str]:
    if (term, *map(str, ticks)) not in derived.holding("segment"):
        return
    if segment.known:
        if (term, segment.name) in derived.holding("named"):
            yield f'named({term},"{segment.name}")'
        return
    for predicate in ("parted_at", "nearest"):
        for place, value in derived.holding(predicate):
            if place == term:
                yield (
                    f"{predicate}({term},{value})"
                    if value.isdigit()
                    else (f'{predicate}({term},"{value}")')
                )


def _explanation(
    segment: Segment,
    reasons: Sequence[Reason],
    briefs: Briefs,
    against: Sequence[Contrast],
    generals: Sequence[str],
) -> Explanation:
    top = reasons[0]
    if len(reasons) > 1:
        below = (*top.because, *reasons[1:])
        top = Reason(top.sentence, top.atom, top.rule, top.frames, top.leading, below)
    told = summary(segment.name, top, briefs, against, generals)
    return Explanation(
        segment.ee,
        segment.index,
        segment.name,
        segment.start_s,
        segment.end_s,
        told.text,
        told.claims,
        top,
        told.names,
    )


def _where(place: Place | None) -> str:
    return "" if place is None else f"{Path(place.file).name}:{place.line}"
