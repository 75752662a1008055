#!/usr/bin/env bash
# tests/fuzz/run.bash BUILD_FOLDER SECONDS [SEED]: runs each fuzzer for that long, the second time from what it has found
# before. Prints the inputs that show something wrong; the exit code is 0 only when there are none.
set -euo pipefail

if (($# < 2 || $# > 3)); then
  echo "usage: tests/fuzz/run.bash BUILD_FOLDER SECONDS [SEED]" >&2
  exit 64
fi
build=$(cd "$1" && pwd -P)
seconds=$2
seed=${3:-1}
programs=$build/tests/fuzz
failed=()

for target in expression assembler formatter disassembler; do
  corpus=$build/corpora/$target
  findings=$build/findings/$target
  mkdir -p "$corpus" "$findings"
  rm -f "$findings"/*
  log=$build/findings/$target.log
  # A source of some kilobytes takes milliseconds, so what takes seconds or much memory is a finding, too.
  if "$programs/fuzz_$target" -seed="$seed" -max_total_time="$seconds" -max_len=4096 -timeout=10 -rss_limit_mb=2048 \
    -print_final_stats=1 -artifact_prefix="$findings/" "$corpus" "$programs/seeds/$target" >"$log" 2>&1; then
    printf '%-12s %s\n' "$target" "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs, nothing found"
    continue
  fi
  failed+=("$target")
  printf '%-12s FOUND SOMETHING\n' "$target"
  grep -v -e '^#' -e '^INFO' "$log" | head -n 60
  for input in "$findings"/*; do
    if [[ -e $input ]]; then
      printf '%s:\n' "$input"
      od -A d -c "$input" | head -n 40
    fi
  done
done
((${#failed[@]} == 0))
