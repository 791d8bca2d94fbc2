"""Thresholds of measuring: every number that decides, with its unit."""

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


@dataclass(frozen=True, slots=True)
class Thresholds(FootThresholds):
    """What separates motion from rest, contact from nearness and a gap from a loss."""

    cutoff_hz: float = 8.0
    """Where the zero-phase low-pass halves the power [Hz]: voluntary motion of limbs lies below
    6 to 8 Hz (Winter, Biomechanics and Motor Control of Human Movement, 2.2)."""

    cutoff_rate_share: float = 0.45
    """Largest cutoff as a share of the rate [1]: a filter needs some band below half the rate."""

    filter_periods: float = 5.0
    """Half the length of the low-pass filter in periods of its cutoff [1]: its weights have
    decayed there to less than a billionth of the largest."""

    gap_s: float = 0.1
    """A shorter loss of tracking is interpolated, a longer one carries no events [s] (spec 3)."""

    dropout_s: float = 0.1
    """A shorter interruption of a contact is closed [s] (spec 4)."""

    contact_minimum_s: float = 0.05
    """A shorter contact is dropped [s] (spec 4). So is a shorter arrangement of two bodies, a
    shorter look, and a shorter leaning or rolling."""

    passing_s: float = 0.15
    """What goes on past another thing as before may touch it for less than this and does nothing to
    it [s]: a longer touch is meant."""

    passing_mps: float = 0.3
    """... if it is at least so fast [m/s]: what is slower stops there, or is led along it."""

    passing_share: float = 0.5
    """... and if afterwards at least this share of its velocity is left [1]: of a blow nothing is,
    or it turns back; of a push the pushed thing takes all."""

    tolerance_sigmas: float = 3.0
    """Bodies touch within so many deviations of the sensors' noise, unless a capture says [1]."""

    tolerance_least_m: float = 0.005
    """The least such tolerance [m]: skin gives way and meshes are approximate by that much."""

    tolerance_most_m: float = 0.010
    """The largest such tolerance [m]: beyond a centimetre, nearness is no contact."""

    patch_m: float = 0.005
    """Surfaces that are no further apart than this beyond where they are nearest belong to the
    patch at which bodies press on each other [m]: the least tolerance, and the depth of skin."""

    release_sigmas: float = 3.0
    """Between two frames of contact of noisy bodies it lasts while they are nearer than the
    tolerance and so many deviations of what noise the filter leaves [1], twice the tolerance at
    most: noise does not cut a contact in two, and begins and ends none later or sooner."""

    smoothing_noise_m: float = 0.0005
    """A stream noisier than this at rest [m] is low-passed before its contacts are sought."""

    crossing_sigmas: float = 6.0
    """Prominence of an extremum of speed, in deviations of the speed's noise [1]."""

    crossing_speed_mps: float = 0.03
    """Least prominence of an extremum of speed [m/s]: postural sway of a hand stays below."""

    crossing_speed_share: float = 0.03
    """Least prominence as a share of the stream's largest speed [1]."""

    extremum_horizon_s: float = 4.0
    """How far about an extremum of speed its prominence and its neighbours are sought [s]: longer
    than people take to speed up or to slow down."""

    rest_sigmas: float = 4.0
    """A body rests while its speed is below so many deviations of the speed's noise [1]."""

    rest_speed_mps: float = 0.03
    """A body rests in any case while it is slower than this [m/s]."""

    rest_speed_radps: float = 0.3
    """The same for its turning [rad/s]: the rim of a thing of 10 cm is then as fast."""

    rest_window_s: float = 0.2
    """An object's speed is the slope of its way over this time [s]."""

    rest_minimum_s: float = 0.15
    """A shorter standstill is no rest [s] (spec 5.4)."""

    rest_begins_s: float = 0.7
    """Where an object came to rest is the middle of its poses in so much of its rest [s]: enough to
    take the noise out, and no more than live observation waits before it settles anything."""

    motion_floor_m: float = 0.010
    """An object nearer than this to a place where it rests is still there [m]."""

    motion_floor_rad: float = 0.0873
    """The same for its orientation [rad]: five degrees."""

    motion_sigmas: float = 5.0
    """The floor of motion in deviations of the filtered pose's noise, where that is more [1]."""

    moving_minimum_s: float = 0.05
    """A shorter absence from a place is no motion [s]: nobody moves a thing there and back."""

    axis_share: float = 0.1
    """An axis moves if its way is at least this share of the largest axis's way [1]."""

    reversal_m: float = 0.05
    """Steep way up and steep way down that make a reversal of height [m] (spec 10): the half of a
    hand's width."""

    bend_rad: float = 0.7854
    """Slope of a path at which it goes up or down as much as aside [rad]: 45 degrees (spec 10)."""

    flat_rad: float = 0.6109
    """A steep path becomes level below this slope [rad]: 35 degrees (spec 10)."""

    steep_rad: float = 0.9599
    """A level path becomes steep above this slope [rad]: 55 degrees (spec 10)."""

    swing_m: float = 0.010
    """Least way between turning points of motion to and fro [m]: the floor of motion."""

    swing_s: float = 0.9
    """Longest time between them [s]: at one stroke a second a motion to and fro breaks up into
    strokes by themselves (Park, Marino, Charles, Sternad and Hogan, Moving slowly is hard for
    humans, 2017)."""

    slender_ratio: float = 3.0
    """A body is long and thin if it is so many times as long as wide [1]: a knife is six times, a
    whisk or a wide saw four times, a cloth or a sponge less than twice."""

    lengthwise_share: float = 0.7071
    """A body goes along its length if that is this share of its path [1]: the cosine of 45 degrees.
    One that goes in circles has two thirds."""

    pocket_share: float = 0.15
    """Nothing fits in a body whose convex hull is nowhere further from its surface than this share
    of its size [1]: of a cup or a bowl it is a third, of a plate or an apple a tenth."""

    enclosed_share: float = 0.5
    """From the middle of a hollow, the body's own surface is seen in more than this share of all
    directions [1]: of a cup in seven tenths, of a bowl in six, of a banana in two."""

    swing_turns: int = 4
    """Fewest turning points of motion to and fro [1]: two whole periods less one half."""

    lean_rad: float = 0.5236
    """Angle from the vertical beyond which an object leans [rad]: thirty degrees."""

    slip_share: float = 0.3
    """A body rolls while the point below its middle is slower than this share of its middle's
    speed [1]: were it one, the body would slide; people's hands make round things slip a little."""

    roll_rad: float = 0.7854
    """A smaller turn is no rolling [rad]: 45 degrees. The middle of a thing that is tipped over
    its edge is near enough above the edge for 35 degrees that it slips no more than that."""

    blow_s: float = 0.1
    """A blow is over within this time, and the low-pass blurs it by no more [s]."""

    struck_mps: float = 0.3
    """A thing that lay, and is as fast within that time, was struck [m/s]: that takes 3 m/s2, twice
    what a hand gives to what it pushes or takes along."""

    fall_share: float = 0.3
    """A body falls freely while its acceleration is within this share of gravity's [1]."""

    fall_minimum_s: float = 0.06
    """A shorter fall is none [s]: it falls less than two centimetres meanwhile."""

    ride_share: float = 0.25
    """What is borne goes along while it shifts on its bearer by no more than this share of the
    bearer's way [1]: a load slides or rolls a little; what stays behind shifts by the whole."""

    level_m: float = 0.03
    """Feet that rest within this height of the lowest rest stand on one level [m]: the sole of a
    foot and the noise of a tracker are that thick."""

    steep: float = 0.7071
    """Cosine of 45 degrees: what is flatter bears from below [1]."""

    hand_width_m: float = 0.1
    """A hand's width [m], as in the rules: a hand that has shifted farther on an object grasps it
    elsewhere."""

    near_m: float = 0.15
    """Bodies whose boxes are nearer than this are beside each other [m]: a hand's length."""

    near_stays_m: float = 0.2
    """... and they are so until they are further apart than this [m]: a third more."""

    inside_share: float = 0.5
    """Share of a body that lies in another's hull, from which on it is inside [1]."""

    inside_stays_share: float = 0.4
    """... and it is so while at least this share lies there [1]: a fifth less."""

    along_rad: float = 0.5236
    """Largest angle between motion along a body and its longest axis [rad]: thirty degrees."""

    edge_m: float = 0.001
    """From a place of rest a motion that is known begins at this distance [m]: the tenth part of
    its floor, and still more than trackers of the day make of a thing that lies."""

    onset_s: float = 0.3
    """At most so long before it is that far a motion began [s]: of a way of 20 cm that is covered
    smoothly in four seconds the first millimetre takes that long. What takes longer drifts."""

    creep_s: float = 0.6
    """At most so long before it is beyond its floor a motion begins, and ends after it [s]: at the
    slowest at which people move things on purpose, 2 cm/s, half a second and the time to get
    there; what takes longer drifts, as what is held still does."""

    edge_rad: float = 0.00873
    """The same for its orientation [rad]: half a degree."""

    co_motion_window_s: float = 0.4
    """Bodies move as one if they do for so long [s]: a hand that passes a thing is faster."""

    co_motion_way_m: float = 0.03
    """Least way of a thing through the world in that window that tells with whom it moves [m]:
    three floors of motion."""

    co_motion_stray_m: float = 0.010
    """It is steady in a frame in which it strays no farther than this meanwhile [m]: the floor
    of motion, which a firm grip keeps to."""

    co_motion_share: float = 0.25
    """Or no farther than this share of its way through the world [1]: a thing slips and turns in
    a loose grip, and one that is left behind strays as far as it or the hand goes."""

    co_motion_least: float = 0.2
    """Who moves as one with a thing for a smaller share of its motion does so by chance [1]."""

    company_reach_m: float = 0.1
    """Of a hand or thing whose box is farther than this from what moves as one with it, the
    distance of the boxes is told for that of the surfaces [m]: no hand carries what is so far."""

    touch_quantile: float = 0.95
    """Quantile of the distances in frames of evidence that counts as touching [1] (spec 10)."""

    touch_margin_m: float = 0.02
    """What is added to that quantile [m]: how far fingers open about what they let go (spec 10)."""

    touch_ridge: float = 0.02
    """Weight of a point's distance from its body's origin, against the misfit, where two points
    that come together are sought [1]: of bodies that hardly turn against each other they lie
    midway between the origins, and a misfit of a hundredth of their distance is left."""

    settle_reach_m: float = 0.25
    """A body known by its origin alone touches nothing whose origin is farther than this [m]: a
    hand's length and the half of a thing that one hand can hold."""

    settle_nearer_m: float = 0.03
    """Where a distance settles counts as touching if it is so much shorter than where the bodies
    rest apart [m]: a hand's thickness."""

    dwell_s: float = 1.0
    """What is held dwells where its mean over this time stays [s]: two turns of stirring."""

    dwell_m: float = 0.05
    """Way of that mean within the same time, below which it dwells [m]."""

    guide_floors: float = 3.0
    """A hinge or a rail is sought for what turns or goes by so many floors of its motion [1]:
    15 degrees or 3 cm, as for co-motion; in less any line fits."""

    hinge_edge_share: float = 0.1
    """A hinge is in the outer tenth of the breadth of what turns about it, or beyond [1]: what is
    turned on the spot turns about its middle."""

    hinge_near_m: float = 0.05
    """... no farther than this from it, and from the body that bears it [m]: the breadth of a
    hinge's leaf. As near to the edge of that body, a lid's hinge is at its edge."""

    flush_m: float = 0.03
    """A closed lid or door is so near to what it closes, all over [m]: seals, stops and the height
    of a rim are that thick."""

    closed_share: float = 0.75
    """Share of a lid or door that is flush, or of a drawer or door that is inside, where it is
    closed [1]: fronts, handles and overlaps stand out by the other quarter."""

    withdrawn_share: float = 0.05
    """What is open is less inside by at least this share [1]: 3 cm, a rail's least, of 60 cm."""

    rail_play_m: float = 0.03
    """What guides a drawer is so near on both sides of it [m]; what is pushed onto a shelf has room
    for a hand there, and nothing keeps it on its line."""
