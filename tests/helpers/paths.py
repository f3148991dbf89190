"""Path elements in one line each."""

from footfall.scenarios.path import Path, PathSpec, build_path


def straight(length, grade=0.0):
    return {"kind": "straight", "length_m": length, "grade_percent": grade}


def arc(radius, turn_deg, grade=0.0):
    return {"kind": "arc", "radius_m": radius, "turn_deg": turn_deg, "grade_percent": grade}


def corner(turn_deg, radius=2.5, grade=0.0):
    return {"kind": "corner", "turn_deg": turn_deg, "radius_m": radius, "grade_percent": grade}


def build(*elements, **keys) -> Path:
    return build_path(PathSpec(elements=list(elements), **keys))
