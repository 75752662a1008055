"""A host drives a virtual module through its serial port."""

import os
import signal
import unittest

import tmcl_host
from tmcl_host import (ACTUAL_POSITION, ACTUAL_SPEED, GAP, MST, MVP, OK, POSITION_REACHED, ROL, ROR, VERSION,
                       SimulationTest, TemporaryFolderTest, eventually)


class Motion(SimulationTest):
    def test_moves_and_polls_until_the_position_is_reached(self):
        for target in (5000, -3000, 0):
            self.assertEqual(target, self.host.do(MVP, 0, 0, target))
            eventually(lambda: self.host.get(POSITION_REACHED), "position %d" % target)
            self.assertEqual(target, self.host.get(ACTUAL_POSITION))

    def test_moves_by_a_distance(self):
        self.host.do(MVP, 0, 0, 1000)
        eventually(lambda: self.host.get(POSITION_REACHED), "position 1000")
        self.assertEqual(600, self.host.do(MVP, 1, 0, -400))
        eventually(lambda: self.host.get(POSITION_REACHED), "position 600")
        self.assertEqual(600, self.host.get(ACTUAL_POSITION))

    def test_rotates_right_and_left_and_stops(self):
        for opcode, sign in ((ROR, 1), (ROL, -1)):
            self.host.do(opcode, 0, 0, 400)
            eventually(lambda: self.host.get(ACTUAL_SPEED) == sign * 400, "full speed")
            before = self.host.get(ACTUAL_POSITION)
            eventually(lambda: sign * (self.host.get(ACTUAL_POSITION) - before) > 0, "a change of position")
            self.host.do(MST)
            eventually(lambda: self.host.get(ACTUAL_SPEED) == 0, "standstill")


class Identity(TemporaryFolderTest):
    def test_each_module_says_what_it_is(self):
        for module, number, text in (("pd1161", 0x0489012F, b"1161V147"), ("tmcm1110", 0x04560108, b"1110V108")):
            simulation = self.start(module)
            host = simulation.host()
            self.assertEqual(number, host.do(VERSION, 1))
            host.send(tmcl_host.request(VERSION, 0))
            self.assertEqual(b"\x02" + text, host.receive())
            host.close()
            simulation.stop()


class SerialPort(SimulationTest):
    def test_is_found_under_a_stable_name(self):
        self.assertEqual(self.simulation.introduction["pty"], os.readlink(self.simulation.link))
        self.assertEqual(self.simulation.link, self.simulation.introduction["link"])

    def test_survives_a_hundred_hosts_that_come_and_go(self):
        self.host.close()
        for i in range(100):
            host = self.simulation.host()
            self.assertEqual(i, host.do(tmcl_host.SGP, 7, 2, i))
            host.close()
        self.assertIsNone(self.simulation.process.poll())

    def test_survives_a_host_that_leaves_without_reading_its_reply(self):
        for _ in range(20):
            host = self.simulation.host()
            host.send(tmcl_host.request(GAP, 1))
            host.close()
        # The port of the test's own host was open all the time; what is left in it is nobody's.
        self.host.port.reset_input_buffer()
        eventually(lambda: self.answers_after_silence(), "an answer to a fresh request")

    def answers_after_silence(self):
        self.host.port.reset_input_buffer()
        self.host.port.timeout = 0.2
        self.host.send(tmcl_host.request(GAP, 140))
        data = self.host.port.read(100)
        return data.endswith(bytes([2, 1, OK, GAP, 0, 0, 0, 8, 2 + 1 + OK + GAP + 8]))


class End(TemporaryFolderTest):
    def test_removes_the_link_and_succeeds_on_either_signal(self):
        for how in (signal.SIGINT, signal.SIGTERM):
            simulation = self.start("pd1161")
            self.assertTrue(os.path.islink(simulation.link))
            self.assertEqual(0, simulation.stop(how))
            self.assertFalse(os.path.lexists(simulation.link))

    def test_a_link_left_behind_by_a_killed_one_is_replaced(self):
        simulation = self.start("pd1161")
        simulation.stop(signal.SIGKILL)
        self.assertTrue(os.path.islink(simulation.link))
        replacement = self.start("pd1161")
        host = replacement.host()
        self.assertEqual(8, host.get(140))
        host.close()

    def test_a_link_in_use_is_not_taken_away(self):
        simulation = self.start("pd1161")
        second = self.tmcl("sim", "pd1161", "--tcp", "none", "--pty-link", simulation.link, "--quiet")
        self.assertEqual(74, second.returncode)
        self.assertIn("in use", second.stderr)
        self.assertEqual(simulation.introduction["pty"], os.readlink(simulation.link))

    def test_ends_by_itself_after_its_duration(self):
        program = self.write("turn.tmc", "Loop: ROR 0, 500\nWAIT TICKS, 0, 100\nROL 0, 500\nWAIT TICKS, 0, 100\nJA Loop\n")
        ended = self.tmcl("sim", "--speed", "max", "--duration", "30s", "--program", program, "--tcp", "none", "--pty-link",
                          self.path("link"))
        self.assertEqual(0, ended.returncode, ended.stderr)
        self.assertIn("position", ended.stderr)


if __name__ == "__main__":
    tmcl_host.main()
