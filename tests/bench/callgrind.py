"""Counts processor instructions with valgrind's callgrind: what the *_instructions.py programs share.

The counts are exact and the same in every run of the same program. What one repetition costs is the difference between
two runs, one with twice as many repetitions as the other, so that start-up and end cancel.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

REPETITIONS = 1000  # as many digits as twice as many, so that both runs start alike
EXIT_ABOVE_LIMIT = 1
EXIT_USAGE = 64
EXIT_INTERNAL = 70


class MeasurementError(Exception):
    """A run that does not give a figure."""


def instructions_of_run(command):
    """All instructions of one run of a program."""
    with tempfile.TemporaryDirectory() as folder:
        profile = pathlib.Path(folder) / "profile"
        line = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}", *map(str, command)]
        run = subprocess.run(line, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise MeasurementError(f"{' '.join(line)}: exit code {run.returncode}\n{run.stderr}")
        total = re.search(r"^(?:summary|totals): (\d+)$", profile.read_text(), re.MULTILINE)
        if total is None:
            raise MeasurementError(f"{' '.join(line)}: the profile has no sum")
        return int(total[1])


def instructions_per_repetition(command, repetitions=REPETITIONS):
    """`command` is a program and its arguments without the last, which is the number of repetitions."""
    once = instructions_of_run([*command, repetitions])
    twice = instructions_of_run([*command, 2 * repetitions])
    if twice <= once:
        raise MeasurementError(f"{command}: {2 * repetitions} repetitions took no more than {repetitions}")
    return (twice - once) / repetitions


class Parser(argparse.ArgumentParser):
    """--build and --limit; ends with the exit code of this project for wrong usage.

    `limited` are the names that a limit can have, `what` is how the help calls them, `figure` what they limit.
    """

    def __init__(self, description, limited, what, figure):
        super().__init__(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
        self.add_argument("--build", default="build/benchmark", metavar="FOLDER", help="default: %(default)s")
        self.add_argument(
            "--limit",
            type=limit_parser(limited),
            action="append",
            default=[],
            metavar=f"{what}=FIGURE",
            help=f"highest {figure}; {what} is {', '.join(limited)}; may be given several times",
        )

    def error(self, message):
        self.print_usage(sys.stderr)
        self.exit(EXIT_USAGE, f"{self.prog}: {message}\n")


def limit_parser(names):
    """Parses NAME=FIGURE into a pair."""

    def parse(text):
        name, _, figure = text.partition("=")
        if name not in names:
            raise argparse.ArgumentTypeError(f"{name!r} is none of {', '.join(names)}")
        try:
            return name, float(figure)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{figure!r} is no number") from None

    return parse


def exit_code(figures, limits):
    """Says which figures, by name, are above their limits."""
    result = 0
    for name, limit in limits:
        if figures[name] > limit:
            print(f"{name}: {figures[name]:.1f} instructions are above the limit of {limit:g}", file=sys.stderr)
            result = EXIT_ABOVE_LIMIT
    return result
