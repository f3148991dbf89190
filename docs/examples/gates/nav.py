"""A heading correction of one's own: HDR that also works where the path bends a little more."""

from footfall.hdr.correct import turned_positions
from footfall.hdr.hdr import HdrParams, trace
from footfall.pdr.track import Track


def mine(footfalls, start):
    """HDR with theta_w of 0.27 deg/s."""
    heading = trace(footfalls, HdrParams.from_degrees(theta_w_deg_s=0.27)).heading
    return Track(t=footfalls.t, position=turned_positions(footfalls, heading), heading=heading)


mine.needs = "footfalls"
