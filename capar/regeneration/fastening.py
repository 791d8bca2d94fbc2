"""Doors and drawers go along with what bears them, and what a hand takes with another thing."""

from dataclasses import replace

from capar.regeneration.scenes import Scene, moved, resized, taken_with


def moved_with(scene: Scene, name: str, place: tuple[float, float, float], heading: float) -> Scene:
    """The scene with a thing elsewhere, and what goes with it as it was beside it."""
    old = scene.thing(name)
    changed = moved(scene, name, place, heading)
    by = changed.thing(name).pose * old.pose.inv()
    for rider in _riders(scene, name):
        thing = scene.thing(rider)
        x, y, z = (float(value) for value in by.apply(thing.place))
        changed = moved(changed, rider, (x, y, z), thing.heading + heading - old.heading)
    return changed


def resized_with(scene: Scene, name: str, factor: float) -> Scene:
    """The scene with a thing of another size, and what goes with it likewise."""
    old = scene.thing(name)
    changed = resized(scene, name, factor)
    for rider in _riders(scene, name):
        local = factor * old.pose.inv().apply(scene.thing(rider).place)
        x, y, z = (float(value) for value in changed.thing(name).pose.apply(local))
        thing = resized(scene, rider, factor).thing(rider)
        things = {**changed.things, rider: replace(thing, place=(x, y, z))}
        changed = replace(changed, things=things)
    return changed


def bases(scene: Scene) -> list[str]:
    """Names of what bears hinges or rails, sorted."""
    return sorted(set(scene.fastened.values()))


def _riders(scene: Scene, name: str) -> list[str]:
    fastened = [rider for rider, base in scene.fastened.items() if base == name]
    return [*fastened, *taken_with(scene, name)]
