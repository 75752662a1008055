#!/usr/bin/env python3
"""Counts processor instructions per direct-mode command with valgrind's callgrind.

Usage: direct_mode_instructions.py [--build FOLDER] [--limit FEED=FIGURE ...] [--models] [--mix-only]

Each figure is the difference between two runs, one with twice as many repetitions as the other, so that start-up and
end cancel; what is left is divided by the commands sent. What the benchmark's own loop and port cost is measured with
nothing behind the port and subtracted. The counts are exact and the same in every run of the same program. The limits
are for the mean over the mix with the chips as register files. Exit codes: 0 done, 1 a mean is above its limit,
64 usage, 70 a run failed or counts made no sense.
"""

import collections
import concurrent.futures
import os
import pathlib
import subprocess
import sys

import callgrind

FEEDS = {"handle": "whole datagram", "whole": "from the port", "bytes": "byte by byte"}
CHIPS = {"registers": "chips as register files", "models": "chip models"}
NOTHING = "none"  # behind the port: the cost of loop and port
MIX = "mix"

Measurement = collections.namedtuple("Measurement", "chips feed command")


def instructions_per_command(program, measurement, command_count):
    """Mean over the commands of the measurement: one, or all of the mix."""
    command = [program, measurement.feed, measurement.chips, measurement.command]
    return callgrind.instructions_per_repetition(command) / (command_count if measurement.command == MIX else 1)


def print_table(chips, names, rows, counts):
    print(f"\nInstructions per command, {CHIPS[chips]}\n")
    print(f"{'':20}" + "".join(f"{title:>16}" for title in FEEDS.values()))
    for row in rows:
        name = "mean over the mix" if row == MIX else names[row]
        values = (counts[Measurement(chips, feed, row)] for feed in FEEDS)
        print(f"{name:20}" + "".join(f"{value:16.1f}" for value in values))
    own = (counts[Measurement(NOTHING, feed, MIX)] for feed in FEEDS)
    print(f"{'subtracted':20}" + "".join(f"{value:16.1f}" for value in own))


def parse_arguments():
    parser = callgrind.Parser(__doc__, limited=FEEDS, what="FEED", figure="mean over the mix")
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
    except (OSError, subprocess.CalledProcessError, callgrind.MeasurementError) as error:
        print(error, file=sys.stderr)
        return callgrind.EXIT_INTERNAL

    for chips in chips_wanted:
        print_table(chips, names, rows, counts)
    means = {feed: counts[Measurement("registers", feed, MIX)] for feed in FEEDS}
    return callgrind.exit_code(means, arguments.limit)


if __name__ == "__main__":
    sys.exit(main())
