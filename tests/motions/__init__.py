"""Captures of known truth: minimum-jerk people who drink, touch, slide, lift and hit.

Which of them a human body can perform is told in ``POSSIBLE.md``.
"""

from motions.drink import drink_from_mug as drink_from_mug
from motions.handing import hand_over as hand_over
from motions.performers import CHILD as CHILD
from motions.performers import PERFORMERS as PERFORMERS
from motions.performers import TALL_MAN as TALL_MAN
from motions.performers import WOMAN as WOMAN
from motions.performers import Performer as Performer
from motions.pick_up import pick_up_with_both_hands as pick_up_with_both_hands
from motions.rolling import roll_object as roll_object
from motions.rows import hit as hit
from motions.rows import move_obj as move_obj
from motions.rows import move_obj_to as move_obj_to
from motions.rows import resume_posture as resume_posture
from motions.rows import touch as touch
from motions.rows import touch_with as touch_with
from motions.standing import stand_on_one_leg as stand_on_one_leg
from motions.touching import slide_object as slide_object
from motions.touching import touch_cycle as touch_cycle
from motions.touching import touch_from_rest as touch_from_rest
from motions.transforms import renamed as renamed
from motions.transforms import reordered as reordered
from motions.transforms import rotated as rotated
from motions.trials import Sampling as Sampling
from motions.trials import Trial as Trial
from motions.trials import TrueContact as TrueContact
from motions.trials import Truth as Truth
