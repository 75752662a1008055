"""The programs in examples/programs: what their scenarios cannot see, and that none of them goes without one."""

import csv
import glob
import os
import shutil
import signal
import socket
import subprocess
import sys
import tomllib
import unittest

import tmcl_host
from farm_test import Farm, ask
from tmcl_host import ACTUAL_POSITION, DEADLINE, GAP, MVP, SGP, TemporaryFolderTest, eventually

PROJECT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDER = os.path.join(PROJECT, "examples", "programs")
GIO = 15


class CameraTrigger(TemporaryFolderTest):
    def test_each_pulse_begins_at_its_place_and_is_as_long_as_the_exposure(self):
        recording = self.path("pictures.csv")
        done = self.tmcl("sim", "--scenario", os.path.join(FOLDER, "camera_trigger.toml"), "--speed", "max", "--quiet",
                         "--tcp", "none", "--pty-link", self.path("link"), "--record", recording,
                         "--signals", "outputs,stage", "--record-every", "1ms")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        with open(recording, encoding="utf-8", newline="") as file:
            rows = [[float(value) for value in row] for row in list(csv.reader(file))[1:]]
        begins, lengths, was_on = [], [], False
        for time, outputs, stage in rows:
            is_on = int(outputs) & 1 == 1
            if is_on and not was_on:
                begins.append((time, stage))
            if was_on and not is_on:
                lengths.append(time - begins[-1][0])
            was_on = is_on
        self.assertEqual(10, len(lengths))
        for number, (_, stage) in enumerate(begins, 1):
            self.assertAlmostEqual(0.5 * number, stage, delta=0.01)
        for length in lengths:
            self.assertAlmostEqual(0.010, length, delta=0.001)


class MultiDropFollower(TemporaryFolderTest):
    leader, first, second = 1, 3, 4

    def test_two_followers_on_a_line_follow_their_leader_each_with_its_ratio(self):
        for name in ("multi_drop.farm.toml", "multi_drop_follower.tmc"):
            shutil.copy(os.path.join(FOLDER, name), self.folder)
        farm = Farm(self.path("multi_drop.farm.toml"))
        self.addCleanup(farm.stop)
        line = socket.create_connection(("127.0.0.1", int(farm.buses["line"]["tcp"].rsplit(":", 1)[1])), DEADLINE)
        self.addCleanup(line.close)
        is_silent = lambda address: ask(line, GIO, 1, 2, address=address).value == 1
        eventually(lambda: is_silent(self.first) and is_silent(self.second), "both followers miss the host")

        host = subprocess.Popen([sys.executable, "-B", os.path.join(FOLDER, "follow.py"), farm.buses["line"]["link"],
                                 "--baud-rate", "115200"])
        self.addCleanup(host.wait, DEADLINE)
        self.addCleanup(host.terminate)
        eventually(lambda: not is_silent(self.first) and not is_silent(self.second), "both followers hear the host")

        stands_at = lambda address, place: ask(line, GAP, ACTUAL_POSITION, address=address).value == place
        ask(line, SGP, 2, 2, 1, address=self.second)
        ask(line, MVP, 0, 0, 30000, address=self.leader)
        eventually(lambda: stands_at(self.first, 15000), "the first follower goes half as far")
        eventually(lambda: stands_at(self.second, 30000), "the second one goes all the way")
        ask(line, MVP, 0, 0, -10000, address=self.leader)
        eventually(lambda: stands_at(self.first, -5000) and stands_at(self.second, -10000), "they come back")

        host.send_signal(signal.SIGINT)
        self.assertEqual(0, host.wait(DEADLINE))
        eventually(lambda: is_silent(self.first) and is_silent(self.second), "both followers miss the host again")


def read_table():
    with open(os.path.join(FOLDER, "README.md"), encoding="utf-8") as file:
        return file.read()


class EveryProgram(unittest.TestCase):
    programs = sorted(glob.glob(os.path.join(FOLDER, "*.tmc")))

    def test_is_run_by_a_scenario_and_every_scenario_is_in_the_table(self):
        self.assertEqual(10, len(self.programs))
        table = read_table()
        run = set()
        for scenario in glob.glob(os.path.join(FOLDER, "*.toml")):
            self.assertIn("(%s)" % os.path.basename(scenario), table)
            with open(scenario, "rb") as file:
                run.add(tomllib.load(file).get("program"))
        for program in self.programs:
            self.assertIn(os.path.basename(program), run)

    def test_says_how_it_is_wired_and_what_to_change_and_is_in_the_table(self):
        table = read_table()
        for program in self.programs:
            with open(program, encoding="utf-8") as file:
                text = file.read()
            name = os.path.basename(program)
            with self.subTest(program=name):
                self.assertIn("[%s](%s)" % (name, name), table)
                self.assertRegex(text, r"\A// \w")
                self.assertRegex(text, r"(?m)^// Wiring: +\w")
                self.assertRegex(text, r"(?m)^// To change: +\w")


if __name__ == "__main__":
    tmcl_host.main()
