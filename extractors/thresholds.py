"""Thresholds of measuring: every number that decides, with its unit and why it is what it is.

A person's hand is about 10 cm wide and 18 cm long; its floor of motion is 1 cm or five degrees.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Thresholds:
    """What separates motion from rest, contact from nearness, a gap from a loss, and faults.

    Names end in their unit; ``share``, ``sigmas``, ``ratio``, ``cosine`` and counts have none.
    """

    # Faults: parabolas of free flight. Noise of a path, its bend, and what may be left of it.
    flight_noise_m: float = 0.0005  # least noise assumed: that of the best trackers
    flight_bend_sigmas: float = 20.0  # least bend by which acceleration is measured
    flight_change_share: float = 0.12  # most bend of another kind
    flight_noise_sigmas: float = 1.5  # most misfit beside a parabola
    flight_steady_share: float = 0.4  # share of its length that a window slides along and fits
    flight_even_share: float = 0.02  # most of cubic and quartic terms; a hand's are far larger
    flight_even_sigmas: float = 2.5  # ... in deviations of noise
    flight_rim_share: float = 0.1  # part of either end that is not measured
    flight_along_share: float = 0.3  # who keeps the distance to this share of the way goes along
    flight_gain_share: float = 0.1  # least gain of speed; what friction brakes gains none
    flight_across_share: float = 0.2  # least way across the acceleration; what slides goes straight
    gravity_share: float = 0.2  # an acceleration within this share of gravity is gravity
    gravity_off_share: float = 0.35  # ... beyond this share it cannot be
    gravity_cosine: float = 0.9  # free fall is along an axis within 26 degrees; drag makes 15
    unit_share: float = 0.15  # a unit explains a ratio of lengths within this share

    # Faults: sizes and speeds of people and things, sides, orders of quaternions, rests.
    person_most_m: float = 3.0  # most distance of two sensors of a person
    head_to_foot_m: float = 0.4  # least largest distance of head and foot: a sitting child
    trunk_to_limb_m: float = 0.15  # the same of other places of the trunk and hands or feet
    head_to_foot_usual_m: float = 1.5  # usual largest distance, by which a unit is found
    trunk_to_limb_usual_m: float = 0.8  # the same; also of two hands
    hand_most_mps: float = 15.0  # nobody's hand is faster for a tenth of a recording
    hand_usual_mps: float = 1.0  # usual speed of a hand in its fastest tenth
    speed_quantile: float = 0.9  # quantile of speeds that is compared with these
    thing_most_m: float = 6.0  # longest thing that is moved by hand: a ladder
    thing_least_m: float = 0.003  # smallest thing that is tracked: a bead
    thing_usual_m: float = 0.15  # usual size of a thing in a hand
    exchanged_share: float = 0.9  # sides are exchanged in so much of what shows them
    level_gaze: float = 0.5  # least level part of sight that shows where a person faces
    apart_share: float = 0.5  # least part aside of the distance of right and left
    shown_share: float = 0.2  # least share of frames that show the sides
    joined_m: float = 0.012  # most stray of joined bodies: floor of motion, and two noises
    wander_m: float = 0.036  # a body that strays so far wanders
    joined_share: float = 0.1  # what is joined keeps its distance within this share
    turned_rad: float = 0.2618  # bodies turn as one from this turn on: 15 degrees
    order_stretch_s: float = 1.0  # window in which orders of quaternions are compared
    order_stretches: int = 2  # windows that contradict an order; one may be chance
    order_share: float = 0.2  # ... of which at most this share supports it
    order_pairs: int = 400  # most pairs of bodies of a file that are compared
    order_enough: int = 40  # windows after which no further pair is compared
    long_rest_s: float = 0.5  # a rest of this length shows what bears a thing
    level_apart_m: float = 0.05  # heights that no common floor explains: a hand's breadth
    box_overlap_m: float = 0.03  # bodies whose boxes overlap more are inside each other
    rest_share: float = 0.75  # share of rests against what bears them that shows up

    # Feet.
    foot_glides_mps: float = 0.5  # faster than this no foot is set down (Bruening and Ridge 2014)
    belt_share: float = 0.5  # least share of a foot's contact that goes along with a belt
    touch_load_share: float = 0.2  # a foot that bears less merely touches
    feet_apart_m: float = 0.1  # nearer feet share the weight in unknown parts: a foot's width
    off_feet_m: float = 0.3  # a body farther from its feet is supported otherwise: a foot's length

    # Filters and losses.
    cutoff_hz: float = 8.0  # the low-pass halves the power here; limbs move slower (Winter 2.2)
    cutoff_rate_share: float = 0.45  # largest cutoff as a share of the rate
    filter_periods: float = 5.0  # half the filter's length in periods of its cutoff
    gap_s: float = 0.1  # a shorter loss is interpolated, a longer one carries no events (spec 3)

    # Contact.
    dropout_s: float = 0.1  # a shorter interruption of a contact is closed (spec 4)
    contact_minimum_s: float = 0.05  # a shorter contact, arrangement, look or lean is dropped
    jaws_s: float = 0.5  # the jaws of a gripper close on a thing, and leave it, within this
    passing_s: float = 0.15  # what passes by may touch for less than this
    passing_mps: float = 0.3  # ... if it is at least so fast
    passing_share: float = 0.5  # ... and keeps at least this share of its velocity
    passing_by_s: float = 1.0  # who goes by on the way to a thing, or from one, is there by then
    brushing_s: float = 1.0  # who touches something fixed for longer does not merely pass over it
    tolerance_sigmas: float = 3.0  # bodies touch within so many deviations of noise
    tolerance_least_m: float = 0.005  # ... and at least this: skin gives way, meshes approximate
    tolerance_most_m: float = 0.010  # ... and at most this
    patch_m: float = 0.005  # depth of the patch at which surfaces press on each other
    release_sigmas: float = 3.0  # noise that cannot cut a contact; twice the tolerance at most
    smoothing_noise_m: float = 0.0005  # a noisier stream is low-passed before contact is sought

    # Zero crossings.
    crossing_sigmas: float = 6.0  # prominence of an extremum of speed, in deviations of noise
    crossing_speed_mps: float = 0.03  # least prominence: postural sway stays below
    crossing_speed_share: float = 0.03  # least prominence as a share of the largest speed
    extremum_horizon_s: float = 4.0  # how far about an extremum its prominence is sought

    # Rest and motion.
    rest_sigmas: float = 4.0  # a body rests while slower than so many deviations of noise
    rest_speed_mps: float = 0.03  # ... and in any case while slower than this
    rest_speed_radps: float = 0.3  # the same for turning: the rim of a thing of 10 cm
    rest_window_s: float = 0.2  # an object's speed is the slope of its path over this time
    rest_minimum_s: float = 0.15  # a shorter standstill is no rest (spec 5.4)
    rest_begins_s: float = 0.7  # poses at the start of a rest whose middle is its place
    motion_floor_m: float = 0.010  # an object nearer than this to its place of rest is there
    motion_floor_rad: float = 0.0873  # the same for its orientation: five degrees
    motion_sigmas: float = 5.0  # the floor in deviations of the filtered noise, where more
    moving_minimum_s: float = 0.05  # a shorter absence from a place is no motion
    axis_share: float = 0.1  # an axis moves if its path is this share of the largest axis's
    edge_m: float = 0.001  # a known motion begins at this distance from its place of rest
    edge_rad: float = 0.00873  # the same for its orientation: half a degree
    onset_s: float = 0.3  # a motion began at most so long before it is that far
    creep_s: float = 0.6  # ... or before it is beyond its floor; longer ones drift

    # Phases of motion.
    reversal_m: float = 0.05  # steep path up and down of a reversal: half a hand's width (spec 10)
    bend_rad: float = 0.7854  # slope at which a path goes up as much as aside
    flat_rad: float = 0.6109  # a steep path becomes level below 35 degrees (spec 10)
    steep_rad: float = 0.9599  # a level path becomes steep above 55 degrees (spec 10)
    steep: float = 0.7071  # cosine of 45 degrees: what is flatter bears from below
    swing_m: float = 0.010  # least path between turning points to and fro
    swing_s: float = 0.9  # longest time between them; slower strokes are single (Park et al. 2017)
    swing_turns: int = 4  # fewest turning points of a motion to and fro
    slender_ratio: float = 3.0  # a long thin body's length over its width
    lengthwise_share: float = 0.7071  # a body moves along its length within 45 degrees
    lean_rad: float = 0.5236  # an object leans beyond 30 degrees from the vertical
    slip_share: float = 0.3  # speed of the lowest point, over the middle's, of what rolls
    roll_rad: float = 0.7854  # a smaller turn is no rolling
    blow_s: float = 0.1  # a blow is over within this time
    struck_mps: float = 0.3  # a thing that lay and is as fast within that time was struck
    fall_share: float = 0.3  # a body falls freely within this share of gravity
    fall_minimum_s: float = 0.06  # a shorter fall is none: less than two centimetres

    # Arrangements.
    pocket_share: float = 0.15  # least depth under the hull, over the size, of what holds something
    enclosed_share: float = 0.5  # least share of directions in which a hollow sees its body
    ride_share: float = 0.25  # most shift on its bearer, over the bearer's path, of a load
    level_m: float = 0.03  # feet that rest within this height stand on one level
    hand_width_m: float = 0.1  # a hand that shifts farther on an object grasps it elsewhere
    near_m: float = 0.15  # bodies whose boxes are nearer are beside each other: a hand's length
    near_stays_m: float = 0.2  # ... until they are further apart than this
    inside_share: float = 0.5  # share in another's hull from which on a body is inside
    inside_stays_share: float = 0.4  # ... while at least this share is
    along_rad: float = 0.5236  # most angle between motion along a body and its longest axis

    # Co-motion, and distances at which bodies without surfaces touch.
    co_motion_window_s: float = 0.4  # bodies move as one if they do for so long
    co_motion_way_m: float = 0.03  # least path in that window: three floors of motion
    co_motion_stray_m: float = 0.010  # most stray in the other's frame meanwhile
    co_motion_share: float = 0.25  # ... or this share of the path: things slip in a loose grip
    co_motion_least: float = 0.2  # a smaller share of a thing's motion is chance
    company_reach_m: float = 0.1  # beyond this gap the distance of boxes is stated
    touch_quantile: float = 0.95  # quantile of distances in evidence that is touching (spec 10)
    touch_margin_m: float = 0.02  # added to it: how far fingers open at a release (spec 10)
    touch_ridge: float = 0.02  # weight of a point's distance from its origin against the misfit
    settle_reach_m: float = 0.25  # origins farther apart never touch: a hand and half a thing
    settle_nearer_m: float = 0.03  # a settled distance is so much shorter than rests apart
    dwell_s: float = 1.0  # what is held dwells where its mean over this time stays
    dwell_m: float = 0.05  # ... within this

    # Hinges and rails.
    guide_floors: float = 3.0  # a guide is sought for motion of so many floors; less fits any line
    hinge_edge_share: float = 0.1  # a hinge is in the outer tenth of what turns, or beyond
    hinge_near_m: float = 0.05  # ... and this near to it and to its base: a hinge's leaf
    flush_m: float = 0.03  # a closed lid or door is so near to what it closes
    closed_share: float = 0.75  # share of a closed lid, door or drawer that is flush or inside
    withdrawn_share: float = 0.05  # an open one is less inside by this share
    part_stray_m: float = 0.003  # most stray of a part on its hinge or rail (spec 11)
    part_stray_rad: float = 0.0524  # ... and of its orientation: three degrees
    outer_share: float = 0.5  # the outer half of a part, seen from its hinge, tells if it is closed
    closed_gap_share: float = 0.1  # ... by its gap over its length: six degrees
    rail_play_m: float = 0.03  # what guides a drawer is so near on both sides of it
