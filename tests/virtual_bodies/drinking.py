"""What a virtual body is seen to do with its right hand."""

from capar.model.observation import Observation


def steps_of(seen: Observation) -> tuple[str, ...]:
    """What the right hand does, with what, without its rests."""
    (link,) = [each for each in seen.links if each.ee == "right_hand"]
    return tuple(
        f"{each.name}({', '.join(each.objects)})" for each in link.segments if each.name != "Rest"
    )
