#!/usr/bin/env python3
"""Counts processor instructions per direct-mode command with valgrind's callgrind.

Usage: direct_mode_instructions.py [--build FOLDER] [--limit FEED=MEAN ...] [--models] [--mix-only]

Each figure is the difference between two runs, one with twice as many repetitions as the other, so that start-up and
end cancel; what is left is divided by the commands sent. What the benchmark's own loop and port cost is measured with
nothing behind the port and subtracted. The counts are exact and the same in every run of the same program. The limits
are for the mean over the mix with the chips as register files. Exit codes: 0 done, 1 a mean is above its limit,
64 usage, 70 a run failed or counts made no sense.
"""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

REPETITIONS = 1000  # as many digits as twice as many, so that both runs start alike
FEEDS = {"handle": "whole datagram", "whole": "from the port", "bytes": "byte by byte"}
CHIPS = {"registers": "chips as register files", "models": "chip models"}
NOTHING = "none"  # behind the port: the cost of loop and port
MIX = "mix"
EXIT_ABOVE_LIMIT = 1
EXIT_USAGE = 64
EXIT_INTERNAL = 70

Measurement = collections.namedtuple("Measurement", "chips feed command")


class MeasurementError(Exception):
    """A run that does not give a figure."""


def instructions_of_run(program, measurement, repetitions):
    """All instructions of one run."""
    with tempfile.TemporaryDirectory() as folder:
        profile = pathlib.Path(folder) / "profile"
        job = [measurement.feed, measurement.chips, str(measurement.command), str(repetitions)]
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}", str(program), *job]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise MeasurementError(f"{' '.join(command)}: exit code {run.returncode}\n{run.stderr}")
        total = re.search(r"^(?:summary|totals): (\d+)$", profile.read_text(), re.MULTILINE)
        if total is None:
            raise MeasurementError(f"{' '.join(command)}: the profile has no sum")
        return int(total[1])


def instructions_per_command(program, measurement, command_count):
    """Mean over the commands of the measurement: one, or all of the mix."""
    once = instructions_of_run(program, measurement, REPETITIONS)
    twice = instructions_of_run(program, measurement, 2 * REPETITIONS)
    if twice <= once:
        raise MeasurementError(f"{measurement}: {2 * REPETITIONS} repetitions took no more than {REPETITIONS}")
    sent = command_count if measurement.command == MIX else 1
    return (twice - once) / (REPETITIONS * sent)


def print_table(chips, names, rows, counts):
    print(f"\nInstructions per command, {CHIPS[chips]}\n")
    print(f"{'':20}" + "".join(f"{title:>16}" for title in FEEDS.values()))
    for row in rows:
        name = "mean over the mix" if row == MIX else names[row]
        values = (counts[Measurement(chips, feed, row)] for feed in FEEDS)
        print(f"{name:20}" + "".join(f"{value:16.1f}" for value in values))
    own = (counts[Measurement(NOTHING, feed, MIX)] for feed in FEEDS)
    print(f"{'subtracted':20}" + "".join(f"{value:16.1f}" for value in own))


def parse_limit(text):
    """FEED=MEAN as a pair."""
    feed, _, mean = text.partition("=")
    if feed not in FEEDS:
        raise argparse.ArgumentTypeError(f"{feed!r} is none of {', '.join(FEEDS)}")
    try:
        return feed, float(mean)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{mean!r} is no number") from None


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.print_usage(sys.stderr)
        self.exit(EXIT_USAGE, f"{self.prog}: {message}\n")


def parse_arguments():
    parser = Parser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/benchmark", metavar="FOLDER", help="default: %(default)s")
    parser.add_argument(
        "--limit",
        type=parse_limit,
        action="append",
        default=[],
        metavar="FEED=MEAN",
        help=f"highest mean over the mix; FEED is {', '.join(FEEDS)}; may be given several times",
    )
    parser.add_argument("--models", action="store_true", help="measure with the chip models, too")
    parser.add_argument("--mix-only", action="store_true", help="no figures for single commands")
    return parser.parse_args()


def measure(program, names, chips_wanted, rows):
    """All figures, by Measurement."""
    jobs = [Measurement(chips, feed, row) for chips in chips_wanted for feed in FEEDS for row in rows]
    own = [Measurement(NOTHING, feed, MIX) for feed in FEEDS]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        counts = dict(
            zip(jobs + own, pool.map(lambda job: instructions_per_command(program, job, len(names)), jobs + own))
        )
    return {
        job: count - (0 if job.chips == NOTHING else counts[Measurement(NOTHING, job.feed, MIX)])
        for job, count in counts.items()
    }


def main():
    arguments = parse_arguments()
    program = pathlib.Path(arguments.build) / "tests/bench/direct_mode_repetitions"
    try:
        names = subprocess.run([program, "list"], capture_output=True, text=True, check=True).stdout.splitlines()
        rows = [MIX] if arguments.mix_only else [*range(len(names)), MIX]
        chips_wanted = list(CHIPS) if arguments.models else ["registers"]
        counts = measure(program, names, chips_wanted, rows)
    except (OSError, subprocess.CalledProcessError, MeasurementError) as error:
        print(error, file=sys.stderr)
        return EXIT_INTERNAL

    for chips in chips_wanted:
        print_table(chips, names, rows, counts)
    exceeded = 0
    for feed, limit in arguments.limit:
        mean = counts[Measurement("registers", feed, MIX)]
        if mean > limit:
            print(f"{FEEDS[feed]}: {mean:.1f} instructions are above the limit of {limit:g}", file=sys.stderr)
            exceeded = EXIT_ABOVE_LIMIT
    return exceeded


if __name__ == "__main__":
    sys.exit(main())
