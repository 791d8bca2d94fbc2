"""Observation while it happens: frames in, segments out, provisional first and settled soon.

``LiveObserver`` measures a sliding window (``LiveHorizons`` states every length and its reason) and
asks the rules about it: provisional 0.4 s after their end, settled 0.5 to 0.75 s after it unless
something named below is awaited. What is settled is not changed while the recording goes on.
``finish`` observes the whole recording as ``capar observe`` does, with the same calibration: the
result is that of the offline run, byte for byte. Until then its frames lie on disk.

Windows overlap, and little is measured twice: contact is asked about only at frames whose poses
differ from the window before. Windows begin at whole seconds and before every motion that goes on.
They are measured twice a second, when a segment that was found is to be settled, when a rest or a
stand has lasted as long as rules ask for, and as soon as an object moves whose first motion decides
something. Sums and low-passed poses from before are carried on (``carried``).

What has to be awaited:

* *Whether a hand takes what it touches* beside another object, or meets as fast as a blow does, is
  known when the object moves, *who takes over an object* that lies on nothing fixed when the other
  lets go of it, and *whether a contact goes on* while one of the two is out of sight when it is
  seen again. All of these are awaited for 2 s.
* *Whether a contact goes on* while the bodies stay near each other, and *whether what is swung is
  swung on*, are awaited for 0.9 s.
* *How a motion is divided* may be known only when it has come down again.
* *Whether what moves again goes on moving* is awaited for 0.2 s from when its motion is seen.
* *Where and when an object came to rest* is known once it has been slow for 0.7 s.
* *Whether an object that has begun to lean far over tipped* is announced only after 2 s.
* *Purposes that nobody states* are the action that follows; they are announced with that.

The solver frees no term that it ever saw, so that it runs in processes that follow each other
(``rule_process``): memory stays flat until the recording ends.
"""
