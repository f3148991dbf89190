"""What a real IMU does to true rates and forces: data sheets, units drawn from them, error effects."""

from footfall.models.imu.names import EFFECTS, require_effects
from footfall.models.imu.spec import (
    ImuSpec,
    SheetDocument,
    ThermalSpec,
    TriadSpec,
    build_spec,
    load_spec,
    read_sheet,
    stock_specs,
)
from footfall.models.imu.temperature import ROOM, TemperatureProfile
from footfall.models.imu.unit import ImuUnit, TriadUnit, draw_unit

__all__ = [
    "EFFECTS",
    "ROOM",
    "ImuSpec",
    "ImuUnit",
    "SheetDocument",
    "TemperatureProfile",
    "ThermalSpec",
    "TriadSpec",
    "TriadUnit",
    "build_spec",
    "draw_unit",
    "load_spec",
    "read_sheet",
    "require_effects",
    "stock_specs",
]
