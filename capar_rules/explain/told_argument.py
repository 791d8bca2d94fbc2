"""What every argument of a told atom knows: itself, what stands beside it, and the recording."""

from collections.abc import Sequence

from capar_rules.borders.ticks import constants, in_frames, times
from capar_rules.explain.clock import Clock
from capar_rules.explain.quantities import Way

UNBOUND = "\0"
"""Stands for what is not known; no sentence may contain it."""


class ToldArgument:
    """An argument of an atom, beside all of its arguments."""

    def __init__(self, text: str, beside: Sequence[str], clock: Clock) -> None:
        self.text, self.beside, self.clock = text, beside, clock

    @property
    def _hand(self) -> str:
        return self.text.removeprefix("seg(").split(",")[0]

    @property
    def body(self) -> str:
        """The body that this argument names; of a segment, its end-effector."""
        return self._hand if self.text.startswith("seg(") else self.text

    def _met_near(self, one: str, other: str, frame: int) -> tuple[int, int] | None:
        merge = in_frames(times().merge_ms, self.clock.rate_hz)
        return self.clock.measured.contact(one, other, frame, merge)

    def _moved(self, body: str, span: tuple[int, int]) -> Way | None:
        ways = self.clock.measured.ways
        return None if ways is None else ways(body, *span)

    def _nothing(self) -> str:
        """That none of what is tracked was touched."""
        if self.clock.measured.stands_uncounted(self.body):
            return "no recorded or assumed object (contact with the floor is not looked for)"
        if self.clock.measured.tracked:
            return "no recorded or assumed object"
        return "no object (the recording has none)"

    def _rest_s(self) -> str:
        return f"{constants()['rest_ms'] / 1000.0:.2f} s"

    def _span_beside(self, form: str) -> tuple[int, int] | None:
        """The span of the segment, or, of a rest, of the two ticks, beside this argument."""
        if form in ("still", "long"):
            first, last = (int(each) for each in self.beside[1:3])
            frames = self.clock.frames[self.beside[0]]
            return frames[first], frames[last]
        terms = [*self.beside, self.clock.own]
        return next((found for each in terms if (found := self.clock.span(each))), None)

    def _when_of(self, frame: int) -> str:
        """A time, and whether it lies before or after the segment that is explained."""
        span, at = self.clock.span(self.clock.own), self.clock.at(frame)
        if span is not None and frame < span[0]:
            return f"before this, at {at}"
        return f"after this, at {at}" if span is not None and frame > span[1] else f"at {at}"
