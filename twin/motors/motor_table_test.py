#!/usr/bin/env python3
"""Mistakes in motors.toml end the build with a message that names the motor, the key and the range."""

import copy
import pathlib
import tomllib
import unittest

import motor_table

FILE = pathlib.Path(__file__).with_name("motors.toml")


class MotorTable(unittest.TestCase):
    def setUp(self):
        self.document = tomllib.loads(FILE.read_text(encoding="utf-8"))

    def mistake(self, change):
        document = copy.deepcopy(self.document)
        change(document)
        with self.assertRaises(motor_table.Mistake) as caught:
            list(motor_table.rows(document))
        return str(caught.exception)

    def test_the_file_itself_has_a_row_for_each_motor(self):
        rows = list(motor_table.rows(self.document))
        self.assertEqual(len(rows), len(self.document["motor"]))
        self.assertIn(".winding_resistance = 0.7,", rows[0])

    def test_a_value_out_of_range_is_named_with_its_range(self):
        message = self.mistake(lambda d: d["motor"][1].update(winding_resistance_ohms=-1))
        self.assertEqual(message, "QSH5718-51-28-101: winding_resistance_ohms is -1, must be 0.02 to 200")

    def test_a_key_with_another_unit_is_unknown(self):
        message = self.mistake(lambda d: d["motor"][0].update(winding_inductance_millihenries=1.4))
        self.assertEqual(message, "QSH5718-41-28-055: unknown key winding_inductance_millihenries")

    def test_a_missing_value_that_nothing_is_assumed_for_is_named(self):
        message = self.mistake(lambda d: d["motor"][0].pop("rotor_inertia_kilogram_square_metres"))
        self.assertEqual(message, "QSH5718-41-28-055: rotor_inertia_kilogram_square_metres must be a number")

    def test_a_text_is_no_number(self):
        message = self.mistake(lambda d: d["assumed"].update(stall_guard_gain="3"))
        self.assertEqual(message, "QSH5718-41-28-055: stall_guard_gain must be a number")

    def test_two_motors_of_one_name_are_refused(self):
        message = self.mistake(lambda d: d["motor"].append(d["motor"][0]))
        self.assertEqual(message, "QSH5718-41-28-055: twice")

    def test_a_detent_as_strong_as_the_field_is_refused(self):
        message = self.mistake(lambda d: d["motor"][0].update(detent_torque_newton_metres=0.2))
        self.assertIn("more than a fifth of the holding torque", message)


if __name__ == "__main__":
    unittest.main()
