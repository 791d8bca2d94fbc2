"""Three people who differ in size, speed, style and where their things stand."""

from dataclasses import dataclass

from capar.model.capture import Agent


@dataclass(frozen=True, slots=True)
class Performer:
    """Who performs, how, and at which table."""

    name: str
    kind: str
    stature_m: float
    mass_kg: float
    pace: float
    """What the durations of moves are multiplied by [1]: more is slower."""

    rise_m: float
    """How far the way to a thing rises above the straight one [m]."""

    swing_m: float
    """How far it swings outward [m]."""

    table_m: float
    """Height of the table [m]."""

    aside_m: float
    """How far to the left things stand [m]."""

    sway_m: float

    @property
    def size(self) -> float:
        """Stature by that of a person of 1.75 m [1]."""
        return self.stature_m / 1.75

    @property
    def agent(self) -> Agent:
        """The performer as a capture tells of him or her."""
        measures = {"stature": self.stature_m, "mass": self.mass_kg}
        return Agent(self.name, self.kind, measures)


TALL_MAN = Performer(
    name="tall_man", kind="man", stature_m=1.87, mass_kg=88.0, pace=1.0, rise_m=0.15,
    swing_m=0.06, table_m=1.05, aside_m=0.0, sway_m=0.003,
)  # fmt: skip
WOMAN = Performer(
    name="woman", kind="woman", stature_m=1.63, mass_kg=61.0, pace=1.14, rise_m=0.28,
    swing_m=0.20, table_m=0.92, aside_m=0.06, sway_m=0.002,
)  # fmt: skip
CHILD = Performer(
    name="child", kind="child", stature_m=1.36, mass_kg=30.5, pace=1.27, rise_m=0.15,
    swing_m=0.02, table_m=0.76, aside_m=-0.04, sway_m=0.004,
)  # fmt: skip

PERFORMERS = (TALL_MAN, WOMAN, CHILD)
