"""Every feature string has its value and its bits, however rarely a capture shows it."""

from capar_rules.engine.solver import rule_file, solve

SHOWN = "#show bit_string/3. #show bit/3."


def lengths() -> set[int]:
    """One bit for the end-effector and each object, and one for each pair of the first object."""
    (most,) = solve(
        [rule_file("inputs.lp"), rule_file("thresholds.lp")],
        "most(most_objects). #show most/1.",
    ).of("most")
    objects = range(1, int(str(most[0])) + 1)
    return {0, *objects, *(2 * each - 1 for each in objects)}


def test_each_string_of_a_length_in_use_is_there_once_with_its_value_and_its_bits() -> None:
    answer = solve([rule_file("naming/bit_strings.lp")], SHOWN)
    written = {
        f"{value:0{length}b}" if length else "": (length, value)
        for length in lengths()
        for value in range(2**length)
    }
    assert sorted(answer.of("bit_string")) == sorted(
        (text, *told) for text, told in written.items()
    )
    bits = {(text, at, int(bit)) for text in written for at, bit in enumerate(text)}
    assert set(answer.of("bit")) == bits
