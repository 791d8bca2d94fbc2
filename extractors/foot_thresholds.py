"""The numbers by which feet stand, with unit, meaning and source."""

from dataclasses import dataclass

from extractors.fault_thresholds import FaultThresholds


@dataclass(frozen=True, slots=True)
class FootThresholds(FaultThresholds):
    """What separates a foot that stands from one that passes, and what each foot bears."""

    foot_glides_mps: float = 0.5
    """A foot is not set down while all of its underside shifts faster along the ground [m/s]:
    between the speed of a heel as it strikes and that of a foot that swings by, three times as
    fast as the body (threshold velocities of 0.05 to 0.8 m/s detect the strike and the leaving of
    feet; Bruening and Ridge, Automated event detection algorithms in pathological gait, 2014)."""

    belt_share: float = 0.5
    """The least share of each foot's contact with a belt through which it goes along with it [1]:
    the rest is setting down, leaving and what swings low."""

    touch_load_share: float = 0.2
    """A foot that bears less than this share of the weight merely touches [1]: what physiotherapy
    calls touch-down weight bearing; if both are down the other one bears all the rest."""

    feet_apart_m: float = 0.1
    """Feet nearer than this share the weight in unknown parts [m]: the width of a foot, within
    which the middle of the body is not known better than to a fifth."""

    off_feet_m: float = 0.3
    """A body whose middle is further from its feet than this is supported by something else too, or
    falls [m]: the length of a large foot."""
