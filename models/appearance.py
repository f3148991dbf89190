"""What the walker and its world look like; nothing here has mass or touches anything."""

from __future__ import annotations

import mujoco

TROUSERS = (0.20, 0.24, 0.34, 1.0)
SHIRT = (0.75, 0.35, 0.25, 1.0)
SKIN = (0.85, 0.68, 0.56, 1.0)
HAIR = (0.25, 0.18, 0.13, 1.0)
SHOE = (0.92, 0.92, 0.95, 1.0)


def add_look(
    body: mujoco.MjsBody, start: list[float], end: list[float], radius: float, rgba: tuple[float, ...]
) -> None:
    """A capsule that is only drawn."""
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[*start, *end],
        size=[radius, 0, 0],
        rgba=rgba,
        contype=0,
        conaffinity=0,
        mass=0,
        group=1,
    )


def add_torso_looks(torso: mujoco.MjsBody) -> None:
    """Trunk and head; their mass is in the torso's inertia."""
    for y in (-0.07, 0.07):
        add_look(torso, [0, y, 0.02], [0, 1.3 * y, 0.36], 0.10, SHIRT)
    add_look(torso, [0, -0.14, 0.385], [0, 0.14, 0.385], 0.065, SHIRT)
    add_look(torso, [0, 0, 0.42], [0.01, 0, 0.50], 0.05, SKIN)
    add_look(torso, [0.015, 0, 0.575], [0.01, 0, 0.63], 0.088, SKIN)
    add_look(torso, [-0.01, 0, 0.60], [-0.005, 0, 0.645], 0.091, HAIR)


def add_sky_and_paving(spec: mujoco.MjSpec) -> None:
    """The sky's texture, and the ground's material `paving`."""
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=[0.60, 0.74, 0.90],
        rgb2=[0.93, 0.95, 0.97],
        width=256,
        height=256,
    )
    spec.add_texture(
        name="paving",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=[0.66, 0.68, 0.66],
        rgb2=[0.62, 0.64, 0.62],
        width=128,
        height=128,
    )
    paving = spec.add_material(name="paving", texuniform=True, texrepeat=[0.5, 0.5])
    paving.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "paving"
