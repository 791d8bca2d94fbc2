"""The worker process of ``rule_process``: facts in, what the rules say of them out.

Input: a pickled profile, then one pickled list of facts after the other. Output: for each list a
pickled pair of the answer, or the error that it raised, and the processor time of this process [s].
"""

import pickle
import sys
import time
from collections.abc import Sequence
from typing import BinaryIO

from capar.model.errors import CaparError
from capar.model.facts import Fact
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import Profile
from capar_rules.pars.inference import Inference, infer


def inferred(facts: Sequence[Fact], rules: Profile) -> Inference:
    """What rules say of facts, their flicker resolved as the profile has it.

    Raises:
        RuleError: The rules have a fault, or not exactly one answer.
    """
    return infer(steady(facts) if rules.steady else tuple(facts), profile=rules)


def serve(asked: BinaryIO, answered: BinaryIO) -> None:
    """Answer until nothing more is asked."""
    rules: Profile = pickle.load(asked)
    while True:
        try:
            facts: Sequence[Fact] = pickle.load(asked)
        except EOFError:
            return
        answer: Inference | CaparError
        try:
            answer = inferred(facts, rules)
        except CaparError as error:
            answer = error
        pickle.dump((answer, time.process_time()), answered, protocol=pickle.HIGHEST_PROTOCOL)
        answered.flush()


if __name__ == "__main__":
    serve(sys.stdin.buffer, sys.stdout.buffer)
