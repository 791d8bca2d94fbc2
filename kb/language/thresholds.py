"""The numbers by which wording decides, each with its unit and its reason.

None of them names, splits or drops a segment: they choose among ways to tell segments that the
rules have named.
"""

REST_S = 0.4
"""A rest of so long [s] parts what is done; the rules have the same for segments (``rest_ms``)."""

SCRAP_S = 0.5
"""What takes less than this [s] within a grip, and goes not far, is no deed of its own: a simple
movement of the arm takes about so long."""

UNSEEN_S = 0.2
"""What takes less than this [s] is no deed wherever it goes: an onlooker takes so long to react."""

SCRAP_M = 0.1
"""So far [m] a scrap goes at most: about a hand's width."""

STILL_M = 0.02
"""What goes less far than this [m] stays where it is: the tolerance of contacts."""

RUNNING_MPS = 0.15
"""A hand that goes faster than this [m/s] over a thing that stays does not hold it: it would have
gone past a hand's width within a second."""

RISEN_M = 0.1
"""What is so far [m] above where it was has been lifted: a hand's width."""

HELD_M = 0.2
"""What is above the ground and ends less far than this [m] from where it was over it has not been
carried anywhere, if it got no further than twice that on the way: whoever holds a large thing up
sways with it by so much."""

PLACE_M = 0.2
"""What is put down less far than this [m] from where it was taken is back almost in its place: less
than a step."""

IN_PLACE_M = 0.1
"""What is put down less far than this [m] from where it was taken is back in its place: a hand's
width."""

LEADS_M = 0.1
"""A hand that is mostly so far [m] before or behind the middle of what slides pulls or pushes it: a
hand's width."""

FURTHER_M = 0.5
"""What is put down further than this [m] from where it was taken is somewhere else on the ground:
about a step."""

POURING_RAD = 1.57
"""What a hand has poured from goes on pouring while it leans more than this [rad]: its mouth is
below level."""

LEVEL_M = 0.03
"""What is let go at this height [m], more or less, stood there already: a finger's width."""

FLOOR_M = 0.03
"""A box that is stated to be lower than this [m] is only the floor of one."""

STEADY_S = 0.5
"""A hand that stays at a thing for so long [s] while another works in it steadies it."""

SETTLING_S = 1.0
"""A hand that stays for less than this [s] at what it has just put down is about to let go."""

UPRIGHT_RAD = 0.79
"""What leans less than this [rad] stands upright: 45 degrees."""

LEANT_RAD = 0.52
"""What leans more than this [rad] while it is carried is carried tilted: 30 degrees, beside which
the sway of carrying is not noticed."""

TIPPED_RAD = 0.26
"""What leans more than this [rad] while it slides stands on some of its legs, or on an edge: 15
degrees, by which one side of a table is a hand's width up."""

OVER_RAD = 2.36
"""What leans more than this [rad] is upside down: 135 degrees."""

AROUND_RAD = 2.09
"""What is turned about the vertical by more than this [rad] faces another way: 120 degrees."""

TURNED_RAD = 0.35
"""What is turned by more than this [rad] is seen to be: 20 degrees, as in the rules
(``turn_mrad``)."""

NOTICED_SHARE = 0.1
"""A turn goes on between its first and its last such share [1], or ``TURNED_RAD`` of a long one."""

TURN_SHARE = 0.05
"""A turn of which every frame is known is told from where this share of it is done to where all but
this share is [1]."""

SAME_TURN = 0.2
"""The line between two hands turns as the thing that they have if their turns differ by less than
this share [1]: else a hand slips on it."""

KNOWN_S = 0.65
"""What begins or ends between two samples that are closer than this [s] is known to about 0.3 s by
their values, which is how closely people tell it."""

SOMEWHAT_RAD = 0.6
"""What is only moved, and turned about the vertical by more than this [rad], is turned: 34 degrees,
more than sways in carrying."""

FACING_M = 0.4
"""What is larger than this [m], as furniture, is seen to face aside when it is carried: smaller
things turn in every hand."""

QUARTER_RAD = 1.05
"""What is turned about the vertical by more than this [rad], and does not face another way, is
turned by about a quarter: 60 degrees."""

TO_AND_FRO_RAD = 3.14
"""What turns by more than this [rad] along its way, and ends turned by less than half of that, is
turned this way and that: half a turn. What turns by twice as much is, however it ends."""

STEP_M = 0.2
"""A foot that comes down less far than this [m] from where it left has not walked: less than the
length of a foot."""

SWING_MPS = 0.3
"""A foot that goes faster than this [m/s] over the ground is on its way: one that stands turns and
rolls more slowly."""

FEW_STEPS = 5
"""Of more steps while a thing is carried, it is not told that they were a few."""

FEWEST_STEPS = 3
"""Who takes fewer steps in turn has stepped somewhere and not walked, as the rules have it
(a walk is three steps or more)."""

STRIDE_S = 1.0
"""Who stands for longer than this [s] between two steps has stopped walking (``halt_ms``)."""

CROUCHED_M = 0.25
"""A pelvis that is so far [m] lower than when the body stands has bent knees below it: a quarter of
a leg, which nobody needs for stooping."""

CROUCHED_SHARE = 0.5
"""Who lowers the pelvis by less than this share of how far the head goes down [1] bends: the trunk
does more of it than the knees."""

BENT_M = 0.3
"""A head that is so far [m] lower than when the body stands is that of one who has bent down: who
nods or leans lowers it by less."""

LEANT_M = 0.2
"""A head that goes so far [m] with a hand that reaches is that of one who leans: nobody moves it so
far by the neck."""

UP_SHARE = 0.2
"""A body that has come up but for this share of how far it was down [1] has straightened up."""

STANDING_M = 0.08
"""A body stands while its pelvis is lower than this [m] at most than it gets: what walking and
leaning make of it."""

REACHED_M = 0.2
"""A free hand that goes less far than this [m] does not reach anywhere: about its own length."""

SWAYING = 0.75
"""A hand that goes less far than this share of what the other goes [1] sways with the body."""

APEX_M = 0.05
"""A free hand has come back when it is no further than this [m] from where it stays: half its
width. It is where it reaches while it is within ``STILL_M`` of its furthest."""

ASIDE_SHARE = 0.5
"""A direction counts in words where a way goes along it by more than this share of the whole [1]:
within 60 degrees."""

ALONG_SHARE = 0.87
"""A head goes the way of a hand where more than this share of its way is along that [1]: within 30
degrees."""

BESIDE_MM = 80
"""What moves as one with a hand that is no further than this [mm] from touching it is in the hand,
where that has touched it before or touches it again (``reach_mm``)."""

PAUSE_S = 8.0
"""Where nothing is done for so long [s], the time is told: an onlooker has begun to wait."""

PAUSE_SHARE = 2.0
"""Such a time is this often [1] as long as half of the others, or longer: else it is how things go
on."""

MOST_LISTED = 10
"""A sentence lists at most so many things."""

MOST_DEEDS = 6
"""A summary names at most so many deeds."""

MINOR_SHARE = 0.5
"""What takes less than this share [1] of the time for which a hand later does the same is not told
beside it in a summary."""

MOSTLY = 0.5
"""What two hands do together for more than this share [1] of the time is told of both in a summary.
"""
