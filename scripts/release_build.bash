# The build folder that ./run and ./test share: build/release. Sourced after packages.bash, with $root set.
# shellcheck shell=bash

build_folder=${root:?}/build/release

# cached NAME: the value of a variable in the build folder's CMake cache, empty when there is none.
cached() {
  sed -n "s/^$1:[A-Z]*=//p" "$build_folder/CMakeCache.txt" 2>/dev/null || true
}

# configure_release ON|OFF: makes sure that the build folder exists, and with tests when they are asked for. Tests once
# switched on stay on, so that ./run after ./test (and back) configures nothing again.
configure_release() {
  local tests=$1
  local fresh=()
  if [[ -e $build_folder/build.ninja && $(cached CMAKE_HOME_DIRECTORY) == "$root" ]]; then
    if [[ $tests == OFF || $(cached OPENTMCL_TESTS) == ON ]]; then
      return 0
    fi
  else
    fresh=(--fresh)  # never finished, or the checkout was copied from another place
  fi
  say "Configuring ${build_folder#"$root"/}"
  cmake -S "$root" --preset release "${fresh[@]}" "-DOPENTMCL_TESTS=$tests" >&2
}

# build_release TARGET: builds it and says so; silent when there is nothing to do.
build_release() {
  local plan
  plan=$(ninja -C "$build_folder" -n "$1" 2>/dev/null) || true
  if [[ $plan == *'no work to do'* ]]; then
    return 0
  fi
  say "Building ${build_folder#"$root"/}, target $1"
  ninja -C "$build_folder" "$1" >&2
}
