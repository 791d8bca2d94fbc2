"""The numbers by which faults of a recording are told, with unit, meaning and source."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class FaultThresholds:
    """What separates what is odd in a recording from what cannot be."""

    flight_noise_m: float = 0.0005
    """Least noise of a path that is taken for a flight's [m]: that of the best trackers."""

    flight_bend_sigmas: float = 20.0
    """Least bend of a path, in deviations of its noise, by which acceleration is measured [1]."""

    flight_change_share: float = 0.12
    """A path is a parabola if no more than this share of its bend is another bend [1]."""

    flight_noise_sigmas: float = 1.5
    """What is left of a path beside a parabola may be so many deviations of its noise more [1]."""

    flight_steady_share: float = 0.4
    """For how much of its own length a window has to slide along a flight and fit [1]."""

    flight_even_share: float = 0.02
    """Cubic and quartic terms of a whole flight are no more than this share of the square one [1]:
    its acceleration then changes by no more than a quarter. Where a hand speeds up it changes by
    all."""

    flight_even_sigmas: float = 2.5
    """... and so many deviations of its noise [1]."""

    flight_rim_share: float = 0.1
    """How much of a flight at either end its acceleration is not taken from [1]: what a window
    reaches beyond it."""

    flight_along_share: float = 0.3
    """Who keeps the distance from a body to this share of its way goes along with it [1]."""

    flight_gain_share: float = 0.1
    """What flies gains at least this share of its change of speed along its acceleration [1]: what
    is braked by friction gains none."""

    flight_across_share: float = 0.2
    """A flight is curved if it goes across its acceleration, or against it, by this share of the
    speed that it gains [1]; what is lowered or slides goes straight."""

    gravity_share: float = 0.2
    """An acceleration is gravity's if it differs by no more than this share of it [1]: drag of the
    air and a wrong middle make a tenth."""

    gravity_off_share: float = 0.35
    """One that differs by more than this share of it cannot be gravity's [1]."""

    gravity_cosine: float = 0.9
    """Free fall is along an axis if the cosine of the angle between them is this [1]: 26 degrees.
    Drag on a light ball makes fifteen."""

    unit_share: float = 0.15
    """A unit of length is the likely one if it explains a ratio but for this share [1]."""

    person_most_m: float = 3.0
    """No two sensors of a person are further apart than this [m]: a hand over the head of a tall
    man is 2.6 m above his feet."""

    head_to_foot_m: float = 0.4
    """Head and foot of a person come at least so far apart within a recording [m]: those of a
    small child that sits."""

    trunk_to_limb_m: float = 0.15
    """... and other places of the trunk and hands or feet [m]: a wrist at one's chin."""

    head_to_foot_usual_m: float = 1.5
    """Usual largest distance of head and foot [m], by which the likely unit is found."""

    trunk_to_limb_usual_m: float = 0.8
    """The same of other places of the trunk and hands or feet [m], and of two hands."""

    hand_most_mps: float = 15.0
    """Nobody's hand or foot is faster than this for a tenth of a recording [m/s]: those of throwers
    and sprinters are for less."""

    hand_usual_mps: float = 1.0
    """Usual speed of a hand in its fastest tenth of a recording [m/s]."""

    speed_quantile: float = 0.9
    """Quantile of speeds that is compared with it [1]."""

    thing_most_m: float = 6.0
    """No thing that people move by hand is longer [m]: a ladder."""

    thing_least_m: float = 0.003
    """None that is tracked is smaller [m]: a bead."""

    thing_usual_m: float = 0.15
    """Usual size of a thing in a hand [m]."""

    exchanged_share: float = 0.9
    """Right and left are exchanged if they lie so in at least this share of the frames that show
    it [1]: people cross their hands, but not for long."""

    level_gaze: float = 0.5
    """Sight shows where a person faces if its level part is at least this [1]."""

    apart_share: float = 0.5
    """Right and left show their sides if at least this share of their distance is aside [1]."""

    shown_share: float = 0.2
    """Sides are judged if as many places of sensors as this share of the frames show them [1]."""

    joined_m: float = 0.012
    """Bodies are joined while one strays no farther than this in the other's frame [m]: the floor
    of motion, and the noise of two trackers."""

    wander_m: float = 0.036
    """One wanders if it strays three times as far [m]."""

    joined_share: float = 0.1
    """What is joined keeps its distance but for this share of it [1]."""

    turned_rad: float = 0.2618
    """Bodies turn as one if the direction between them turns by so much [rad]: fifteen degrees."""

    order_stretch_s: float = 1.0
    """How long each stretch is in which that is asked [s]: a turn of the wrist."""

    order_stretches: int = 2
    """An order is contradicted by so many stretches [1]: one may be chance."""

    order_share: float = 0.2
    """... of which no more than this share supports it as well [1]."""

    order_pairs: int = 400
    """So many pairs of bodies of a file are compared at most [1]: those of twenty bodies."""

    order_enough: int = 40
    """No further pair is compared once so many stretches have shown an order [1]."""

    long_rest_s: float = 0.5
    """A rest of at least this length shows what bears a thing [s]."""

    level_apart_m: float = 0.05
    """Things at the side of a body rest on no common floor if their heights differ by so much
    [m]: a hand's breadth, more than things on one table differ in the height of their middles."""

    box_overlap_m: float = 0.03
    """Bodies whose boxes overlap by more than this are inside each other [m]."""

    rest_share: float = 0.75
    """Rests that are against what bears them in one direction, as a share of all, from which on
    that direction is upward [1]: things also touch what stands beside them."""
