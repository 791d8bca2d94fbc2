"""How arguments tell the parts of a derivation: segments, level paths, and motions to and fro."""

from capar_rules.explain.told_argument import ToldArgument


class DerivationsTold(ToldArgument):
    """What only the tree of reasons says."""

    def _this(self) -> str:
        """The segment that this names: the one that is explained, or whose another one is."""
        own = self.clock.own
        if own in ("", self.text):
            return "the segment"
        span, explained = self.clock.span(self.text), self.clock.span(own)
        same = own.startswith(f"seg({self._hand},")
        if same and span is not None and explained is not None and span[1] == explained[0]:
            return "the segment before this one"
        another = "another" if same else "a"
        return f"{another} segment of the {self.clock.called(self._hand)}"

    def _levels(self) -> str:
        """From or until when the path is level that begins, or ceases, to be so at this tick.

        It is level where it is less steep than 45 degrees.
        """
        frame = self.clock.frames[self.beside[0]][int(self.text)]
        spans = self.clock.measured.level.get(self.beside[3], ())
        for first, last in spans:
            if frame == first:
                return f"from {self.clock.at(first)} on (until {self.clock.at(last)})"
        begun = next((first for first, last in spans if last == frame), None)
        since = f" (from {self.clock.at(begun)} on)" if begun is not None else ""
        return f"until {self.clock.at(frame)}{since}"

    def _swung_on(self) -> str:
        """How long the motion to and fro that goes on at the start lasted before it, and in it."""
        span = self.clock.span(self.beside[0])
        spans = self.clock.measured.swings.get(self.text, ())
        name = self.clock.called(self.text)
        for first, last in spans:
            if span is not None and first < span[0] <= last:
                before, within = (
                    f"{frames / self.clock.rate_hz:.2f} s"
                    for frames in (span[0] - first, min(last, span[1]) - span[0])
                )
                return (
                    f"of the motion of the {name} to and fro from {self.clock.at(first)} to "
                    f"{self.clock.at(last)}, {before} lie before the segment and {within} in it"
                )
        return f"no motion of the {name} to and fro had begun before the segment"
