"""A clause: one thing that was done, before it is put into words."""

from dataclasses import dataclass

from kb.language.lexicalisation import HELPS, MOMENTARY, QUIET, STAYING, TURNED


@dataclass(frozen=True)
class Clause:
    """One thing that was done."""

    pattern: str
    """``put {1} on {2}``: places for objects, and ``{ee}`` for the hand."""

    objects: tuple[str, ...]
    ees: tuple[str, ...]
    """The end-effectors that do it, sorted: one, or both hands."""

    start_s: float
    end_s: float
    changes: bool
    """Whether it changes the world: moves something, strikes it, or is the end itself."""

    purpose: str = ""
    """What it was done for, in words, where nothing else says it: ``pour``."""

    known: bool = True
    count: int = 1
    """How often it was done on end."""

    often: str = ""
    """How often in other words: ``again``."""

    pauses: int = 0
    """How often it was interrupted for so long that people notice it."""

    rests: tuple[tuple[float, float], ...] = ()
    """From when to when it paused [s], where people notice that."""

    apart: tuple[tuple[float, float], ...] = ()
    """From when to when each of several objects was so handled, one after the other [s]."""

    name: str = ""
    """The primitive that it says."""

    general: tuple[str, ...] = ()
    """What the primitive specialises, nearest first."""

    goes_on: bool = False
    """Whether the end-effector touches the same at its end as at its beginning."""

    possessed: bool = False
    """Whether the end-effector possesses the first object."""

    in_turn: tuple[tuple[str, ...], ...] = ()
    """The end-effectors that do it afterwards, one after the other."""

    along: tuple["Clause", ...] = ()
    """How the first object is turned meanwhile, and before, on its way."""

    grip: int = 0
    """How often the end-effector had come to a thing, or left one, when it was done."""

    unseen: bool = False
    """Whether no contact was measured in it: its motion tells that the hand moves the thing."""

    sharp: bool = True
    """Whether it is closely known when it began and ended."""

    rights: bool = False
    """Whether it ends as the first object is turned upright again."""

    @property
    def quiet(self) -> bool:
        """Whether it describes the hand alone."""
        return self.pattern in QUIET

    @property
    def comes(self) -> bool:
        """Whether the end-effector comes to the first object in it."""
        return not self.goes_on and not self.possessed and not self.frees

    @property
    def frees(self) -> bool:
        """Whether the end-effector leaves the first object in it."""
        return self.pattern in MOMENTARY or self.pattern.startswith(("take {ee}", "hand {1} to "))

    @property
    def holds(self) -> bool:
        """Whether the end-effector only stays at the first object in it."""
        stays = not STAYING.isdisjoint((self.name, *self.general))
        return stays and self.goes_on and not (self.changes or self.purpose or self.quiet)

    @property
    def helps(self) -> bool:
        """Whether it moves nothing and yet is a part of what was done."""
        return self.pattern in HELPS

    @property
    def signature(self) -> tuple[object, ...]:
        """What makes two clauses say the same but for hands and times."""
        return self.pattern, self.objects, self.purpose, self.count, self.often, self.pauses

    @property
    def spans(self) -> tuple[tuple[float, float], ...]:
        """From when to when it went on, between its pauses [s]."""
        own = [rest for rest in self.rests if self.start_s < rest[0] and rest[1] < self.end_s]
        begins = (self.start_s, *(end_s for _, end_s in own))
        return tuple(zip(begins, (*(start_s for start_s, _ in own), self.end_s), strict=True))

    def within(self, other: "Clause") -> bool:
        """Whether it is a turning of the same thing that is over as the other clause is."""
        turns = self.pattern in TURNED and self.objects[:1] == other.objects[:1]
        return turns and other.start_s <= self.start_s and self.end_s <= other.end_s

    def overlaps(self, other: "Clause") -> bool:
        """Whether both go on at some time."""
        return self.overlap_s(other) > 0.0

    def overlap_s(self, other: "Clause") -> float:
        """For how long both go on [s]."""
        return min(self.end_s, other.end_s) - max(self.start_s, other.start_s)


def in_time(clause: Clause) -> tuple[float, float, tuple[str, ...]]:
    """The key by which clauses are sorted."""
    return clause.start_s, clause.end_s, clause.ees
