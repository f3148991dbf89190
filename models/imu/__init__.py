"""What a real IMU does to true rates and forces: data sheets, units drawn from them, error effects."""

from footfall.models.imu.effects import EFFECTS, Channel, require_effects, stages
from footfall.models.imu.spec import ImuSpec, ThermalSpec, TriadSpec, load_spec, stock_specs
from footfall.models.imu.temperature import ROOM, TemperatureProfile
from footfall.models.imu.unit import ImuUnit, TriadUnit, draw_unit

__all__ = [
    "EFFECTS",
    "ROOM",
    "Channel",
    "ImuSpec",
    "ImuUnit",
    "TemperatureProfile",
    "ThermalSpec",
    "TriadSpec",
    "TriadUnit",
    "draw_unit",
    "load_spec",
    "require_effects",
    "stages",
    "stock_specs",
]
