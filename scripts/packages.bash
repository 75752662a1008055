# Which Debian packages each script needs, and how they get there. Sourced by ./run, ./test and .ci/run.
# shellcheck shell=bash

# shellcheck disable=SC2034  # the lists are read by the scripts that source this file
packages_to_build=(
  cmake ninja-build g++ ccache python3
  libboost1.81-dev libcli11-dev libfmt-dev libtomlplusplus-dev nlohmann-json3-dev libedit-dev
)
# shellcheck disable=SC2034
packages_to_test=(
  libgtest-dev libgmock-dev librapidcheck-dev
  python3-serial python3-can python3-jsonschema patch neovim emacs-nox elpa-eglot
)
# shellcheck disable=SC2034
packages_to_check=(
  git clang clang-format clang-tidy libclang-rt-14-dev shellcheck valgrind libbenchmark-dev
  gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib
)

# Of Debian 12, Node.js 18 and npm 9, which trust the certificates of the system. Who has an npm of another origin keeps it:
# see install_npm.
packages_for_editors=(nodejs npm ca-certificates)

# say MESSAGE…: what a script does goes to stderr; stdout belongs to the program it starts.
say() {
  printf '%s\n' "$*" >&2
}

# missing_packages PACKAGE…: prints those that are not installed, one a line.
missing_packages() {
  # dpkg-query fails when it does not know a package at all; that package is then simply not in its output.
  comm -23 <(printf '%s\n' "$@" | sort -u) \
    <(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
      sed -n 's/^installed //p' | sort -u)
}

# install_packages REASON PACKAGE…: installs what is missing, as root or through sudo. Silent, and apt is not touched,
# when everything is there.
install_packages() {
  local reason=$1
  shift
  if ! command -v dpkg-query apt-get >/dev/null; then
    return 0  # not a Debian: the compiler and CMake will name what they miss
  fi

  local missing
  mapfile -t missing < <(missing_packages "$@")
  if ((${#missing[@]} == 0)); then
    return 0
  fi

  local as_root=(env)
  if ((EUID != 0)); then
    as_root=(sudo env)
  fi
  say "Installing Debian packages $reason (once; it may take some minutes): ${missing[*]}"
  if ((EUID != 0)) && ! command -v sudo >/dev/null; then
    say "This needs root and there is no sudo. As root: apt-get install ${missing[*]}"
    return 1
  fi
  "${as_root[@]}" apt-get -qq update >/dev/null
  "${as_root[@]}" DEBIAN_FRONTEND=noninteractive \
    apt-get -qq install --yes --no-install-recommends -o Dpkg::Use-Pty=0 "${missing[@]}" >/dev/null
}

# install_npm REASON: Debian's, unless there is one.
install_npm() {
  if ! command -v npm >/dev/null; then
    install_packages "$1" "${packages_for_editors[@]}"
  fi
}
