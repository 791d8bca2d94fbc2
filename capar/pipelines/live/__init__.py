"""Observation while it happens: frames in, segments out, provisional first and settled soon.

``LiveObserver`` measures two sliding windows (``horizons`` states every length and its reason). The
short one names segments: provisional 0.4 s after they end, settled 0.5 to 0.75 s after they end
unless something named below is awaited. What is settled is not told otherwise while the recording
goes on. The long one gives the facts of the result, over all of which ``finish`` asks the rules
once; no frame is measured again, and no more of them are held in memory than the long window holds.

Windows overlap, and little is measured twice. Contact is asked about only at frames whose poses
differ from the window before (``extractors.contact.contacts``); normals of patches are kept
by pose. Short windows begin at whole seconds, so that what is measured at their first frame recurs,
and before every motion that goes on, as how it is parted is told from its beginning. They are
measured twice a second, when a segment that was found is to be settled, when a rest or a stand has
lasted as long as rules ask for, and as soon as a thing moves whose first motion decides something.

Measured with the same calibration, all facts of the result are those of the offline run, as long
as no motion, contact or rest within which something else is sought is longer than the long window.
What has to be awaited, and where the two part:

* *Whether a hand takes what it touches* beside another thing, or meets as fast as a blow does, is
  known when the thing moves, *who takes a thing over* that lies on nothing fixed when the other
  lets go of it, and *whether a contact goes on* while one of the two is out of sight when it is
  seen again. All of these are awaited for 2 s.
* *Whether a contact goes on* while the bodies stay near each other, and *whether what is swung is
  swung on*, are awaited for 0.9 s.
* *How a motion is parted* may be known only when it has come down again: a box that was lifted,
  carried level for 2.5 s and lowered was told as that 2.7 s after the end of the lift.
* *Whether what moves again goes on moving* is awaited for 0.2 s from when its motion is seen, and
  nothing that ends when it set off is announced until then.
* *Where and when a thing came to rest* is known once it has been slow for 0.7 s, which may begin
  later than the stop that it tells. What it parts from a contact before it is announced then.
* *Whether a thing that has begun to lean far over tipped* is announced only after 2 s while it
  leans on. A contact after its segment is settled may still take that back: the result of the
  whole recording has no border there then. No take of ``benchmarks/live_takes.py`` has it.
* *Purposes that nobody states* are the action that follows; they are told when that is settled.
* *Standing on one leg* is known once it has lasted the 0.75 s that its rule asks for.
* *Guides*: a hinge or rail is fitted to every motion of a recording, live to those in the long
  window at its end. It would take the guide as part of the calibration.
* *Objects that nobody has touched yet* are measured from when they are touched: where they lay
  before within the long window is told, what was before it is not.
* *Segments longer than the long window*: style, and where the path begins, are those of its part.
* *Rests longer than* ``rest_s`` are told by their last part.
* *Notices* about the whole recording (losses, sizes, sides, falls) are those of the long windows.
* *Clocks with uneven steps*: the rate is the calibration's.

In the heavy scene of ``benchmarks/live.py`` (12 sensors, 8 objects of 10,000 faces, 103.3 Hz, 12 s)
the observation had the facts and segments of the offline run, no settled segment differed, and half
of the segments were settled within 0.73 s, all within 1.19 s by recorded time; by processor time it
managed 1.27 of real time. Long windows take 0.4 s every 5 s, during which
frames wait. A tracker that is too fast is measured less often, so that segments are announced and
settled later.

Flicker, segments, movers, forces and the complex PAR of the result are decided over all settled
facts and poses when it ends; the time for that grows with the recording. Until then these lie on
disk (``recording_file``). The solver frees no term that it ever saw, so that it runs in processes
that follow each other (``rule_process``): memory is flat.
"""
