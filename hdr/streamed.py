"""Methods on footfalls alone, for recordings too long to be held."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

from footfall.errors import InputError
from footfall.hdr.directions import DirectionParams
from footfall.hdr.tracks import UNTOLD, Reckoning
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import StartPose
from footfall.recording import Recording


class StreamedReckoning(Reckoning):
    """Footfalls without their samples: methods that ask for samples are refused.

    Parameters
    ----------
    run_through : makes the footfalls, when they are asked for
    start, directions : as of `Reckoning`
    """

    def __init__(
        self,
        run_through: Callable[[], Footfalls],
        start: StartPose,
        directions: DirectionParams = UNTOLD,
    ) -> None:
        vars(self).update(run_through=run_through, start=start, directions=directions)

    @cached_property
    def footfalls(self) -> Footfalls:
        """Dead reckoning of the recording."""
        made: Footfalls = vars(self)["run_through"]()
        return made

    @property
    def recording(self) -> Recording:
        """What is not there.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(
            "too long to be held at once, which this method needs: "
            "cut it, or choose a method on footfalls (pdr, hdr, hdr-basic, hypotheses, hde-2010)",
            "recording",
        )
