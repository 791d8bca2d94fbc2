"""Observation while it happens: frames in, segments out, provisional first and settled soon.

``LiveObserver`` measures two sliding windows (``horizons`` states every length and its reason). The
short one names segments: provisional when they end, settled within a second. What is settled is
never told otherwise. The long one gives the facts of the result, which ``finish`` puts together
with the settled segments; no frame is read again, and no more of them are held than the long window
holds.

Measured with the same calibration, all facts of the result are those of the offline run, as long
as no motion, contact or rest within which something else is sought is longer than the long window.
Where the two part, and how much it came to in recordings of half a minute with noise of 0.3 mm,
each with 40 to 85 segments:

* *Where an object comes to rest* is told by the median of its whole rest, which is not over when
  the segment before it is settled. That moves such a border by one frame (10 ms), at most four
  of 40 to 85 segments; names stay.
* *A pause of a free hand* shows by its prominence over up to 4 s after it: one border of 85 was
  not there yet when its segment was settled.
* *Who takes a thing over* is known when the other lets go of it. It is awaited for 2 s.
* *Purposes that nobody states* are the action that follows; they are told when that is settled.
* *Standing on one leg* is known once it has lasted the second that its rule asks for.
* *Guides*: a hinge or rail is fitted to every motion of a recording, live to those in the long
  window at its end. It would take the guide as part of the calibration.
* *Objects that nobody has touched yet* are measured from when they are touched: where they lay
  before within the long window is told, what was before it is not.
* *Segments longer than the long window*: style, and where the path begins, are those of its part.
* *Rests longer than* ``rest_s`` are told by their last part.
* *Notices* about the whole recording (losses, sizes, sides, falls) are those of the windows.
* *Clocks with uneven steps*: the rate is the calibration's.

In the heavy scene of ``benchmarks/live.py`` (12 sensors, 8 objects of 10,000 faces, 103.3 Hz, 18 s)
all 6,229 facts were those of the offline run, and 7 of 53 segments were told otherwise; why has not
been looked into. One core of a busy computer managed 0.13 of real time there, and 1.0 for one hand
at a table: each window is measured anew, which takes 0.15 to 1.2 s. A tracker that is too fast is
measured less often, so that segments are announced and settled later.

Flicker, movers and the complex PAR of the result are decided by rules over all settled facts and
segments when it ends; their time grows with the recording. So do kept facts and sampled places:
without a result (``keep_result=False``) memory does not grow.
"""
