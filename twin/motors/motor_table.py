#!/usr/bin/env python3
"""Turns motors.toml into C++, so that the twin needs no TOML reader.

    motor_table.py motors.toml motors.cpp

Every value is checked; a mistake ends with the motor, the key and the range it left.
"""

import pathlib
import sys
import tomllib

# Key: the member of MotorData, the smallest and the largest value that is no slip of the pen. In the members' order.
NUMBERS = {
    "rated_current_amperes_rms": ("rated_current", 0.05, 20),
    "winding_resistance_ohms": ("winding_resistance", 0.02, 200),
    "winding_inductance_henries": ("winding_inductance", 1e-5, 0.5),
    "holding_torque_newton_metres": ("holding_torque", 0.005, 50),
    "detent_torque_newton_metres": ("detent_torque", 0, 5),
    "rotor_inertia_kilogram_square_metres": ("rotor_inertia", 1e-8, 1e-2),
    "viscous_friction_newton_metre_seconds": ("viscous_friction", 0, 0.1),
    "coulomb_friction_newton_metres": ("coulomb_friction", 0, 1),
    "eddy_damping_newton_metre_seconds": ("eddy_damping", 0, 0.1),
    "winding_time_constant_seconds": ("winding_time_constant", 10, 1e5),
    "temperature_rise_at_rated_current_kelvin": ("temperature_rise_at_rated_current", 1, 200),
    "stall_guard_gain": ("stall_guard_gain", 0.01, 100),
}
TEXTS = ("name", "source")

SOURCE = """// Made from motors.toml.
#include "twin/physics/motor_data.hpp"

namespace opentmcl::twin {{

std::span<const MotorData> motors() {{
  static constexpr MotorData table[] = {{
{rows}  }};
  return table;
}}

}}  // namespace opentmcl::twin
"""


class Mistake(Exception):
    """Something in the file that cannot be used."""


def checked_motor(motor, assumed):
    """The motor with the assumed values filled in, or a Mistake that names the key."""
    name = motor.get("name", "a motor without a name")
    for key in motor:
        if key not in NUMBERS and key not in TEXTS:
            raise Mistake(f"{name}: unknown key {key}")
    for key in TEXTS:
        if not isinstance(motor.get(key), str) or '"' in motor[key] or "\\" in motor[key]:
            raise Mistake(f"{name}: {key} must be a plain text")
    values = assumed | motor
    for key, (_, lowest, highest) in NUMBERS.items():
        value = values.get(key)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise Mistake(f"{name}: {key} must be a number")
        if not lowest <= value <= highest:
            raise Mistake(f"{name}: {key} is {value}, must be {lowest} to {highest}")
    # A fifth: above it the detent would move the rotor as much as the field of a microstep does.
    if values["detent_torque_newton_metres"] > 0.2 * values["holding_torque_newton_metres"]:
        raise Mistake(f"{name}: detent_torque_newton_metres is more than a fifth of the holding torque")
    return values


def rows(document):
    """One C++ initializer for each motor."""
    unknown = [key for key in document if key not in ("assumed", "motor")]
    if unknown:
        raise Mistake(f"unknown key {unknown[0]}")
    assumed = document.get("assumed", {})
    unknown = [key for key in assumed if key not in NUMBERS]
    if unknown:
        raise Mistake(f"assumed: unknown key {unknown[0]}")
    motors = [checked_motor(motor, assumed) for motor in document.get("motor", [])]
    if not motors:
        raise Mistake("no motor")
    names = [motor["name"] for motor in motors]
    for name in names:
        if names.count(name) > 1:
            raise Mistake(f"{name}: twice")
    for motor in motors:
        fields = [f'.{key} = "{motor[key]}"' for key in TEXTS]
        fields += [f".{member} = {float(motor[key])!r}" for key, (member, _, _) in NUMBERS.items()]
        yield "      {" + ", ".join(fields) + "},\n"


def main(arguments):
    if len(arguments) != 3:
        sys.exit(__doc__)
    source = pathlib.Path(arguments[1])
    try:
        text = SOURCE.format(rows="".join(rows(tomllib.loads(source.read_text(encoding="utf-8")))))
    except (Mistake, tomllib.TOMLDecodeError) as error:
        sys.exit(f"{source}: error: {error}")
    pathlib.Path(arguments[2]).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv)
