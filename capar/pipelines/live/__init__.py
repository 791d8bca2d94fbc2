"""Observation while it happens: frames in, segments out, provisional first and settled soon.

``LiveObserver`` measures two sliding windows (``horizons`` states every length and its reason). The
short one names segments: provisional when they end, settled within a second. What is settled is
never told otherwise. The long one gives the facts of the result, which ``finish`` puts together
with the settled segments; no frame is read again, and no more of them are held than the long window
holds.

Windows overlap, and little is measured twice. Contact is asked about only at frames whose poses
differ from the window before (``extractors.contact.earlier_answers``); normals of patches are kept
by pose. Short windows begin at whole seconds, so that what is measured at their first frame recurs.
They are measured twice a second, and when a segment that was found is to be settled.

Measured with the same calibration, all facts of the result are those of the offline run, as long
as no motion, contact or rest within which something else is sought is longer than the long window.
Where the two part:

* *The turn of a free hand*, from withdrawing to reaching, is known at its next contact, however
  late that is: 2 of 631 segments in ten recordings of half a minute with noise of 0.2 to 0.7 mm
  were settled as one with the next.
* *Whether a hand takes what it touches* beside another thing is known when the thing moves, and
  *who takes a thing over* when the other lets go of it. Both are awaited for 2 s: such segments are
  settled later than the others, which are settled within 0.9 s.
* *Purposes that nobody states* are the action that follows; they are told when that is settled.
* *Standing on one leg* is known once it has lasted the second that its rule asks for.
* *Guides*: a hinge or rail is fitted to every motion of a recording, live to those in the long
  window at its end. It would take the guide as part of the calibration.
* *Objects that nobody has touched yet* are measured from when they are touched: where they lay
  before within the long window is told, what was before it is not.
* *Segments longer than the long window*: style, and where the path begins, are those of its part.
* *Rests longer than* ``rest_s`` are told by their last part.
* *Notices* about the whole recording (losses, sizes, sides, falls) are those of the long windows.
* *Clocks with uneven steps*: the rate is the calibration's.

In the heavy scene of ``benchmarks/live.py`` (12 sensors, 8 objects of 10,000 faces, 103.3 Hz, 18 s)
all 6,161 facts and all 54 segments were those of the offline run; one core of a computer with other
work managed 1.2 of real time. Hands touch the table there beside what they grasp, and half a second
passes before they lift it: half of the segments are settled within 0.9 s, 99 in 100 within 1.5 s.
Long windows take 0.4 s every 5 s, during which frames wait. A tracker that is too fast is measured
less often, so that segments are announced and settled later.

Flicker, movers and the complex PAR of the result are decided by rules over all settled facts and
segments when it ends; their time grows with the recording. So do kept facts and sampled places:
without a result (``keep_result=False``) memory does not grow.
"""
