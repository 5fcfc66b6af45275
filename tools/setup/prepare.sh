# Sourced by tools/run, tools/test and tools/package: what the machine lacks is installed, then the release build is configured and built.
# Nothing here is done twice: a second call finds packages, configuration and objects in place.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$root"
program=$root/build/release/gaussdrift

packages_to_build="g++ cmake ninja-build pkg-config libvtk9-dev libexpat1-dev zlib1g-dev libnetcdf-dev libsleef-dev libosmesa6-dev libeigen3-dev
  libtomlplusplus-dev libmuparser-dev libcli11-dev libfmt-dev nlohmann-json3-dev fonts-dejavu-core python3-dev python3-numpy pybind11-dev"
packages_to_test="libgtest-dev python3 python3-scipy python3-pip python3-venv python3-wheel python3-setuptools man-db mypy python3-vtk9 clang libomp-dev clang-format-14 doxygen"

say() { printf '%s\n' "$*" >&2; }

# Whether the program is there and no source is younger. Then it runs whatever became of the packages that it was built with,
# as where a later one has removed them.
is_built() {
  [[ -x $program ]] || return 1
  local younger
  younger=$(find CMakeLists.txt CMakePresets.json cmake include src -newer "$program" -print -quit) && [[ -z $younger ]]
}

# install_missing PACKAGE...
install_missing() {
  if ! command -v dpkg-query >/dev/null; then
    say "This is not a Debian system, so nothing is installed; CMake will name what it misses."
    return
  fi
  local missing=() package
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null) == ii* ]] || missing+=("$package")
  done
  ((${#missing[@]})) || return 0

  local as_root=()
  if [[ $(id -u) != 0 ]]; then
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }; then
      as_root=(sudo)
    else
      say "Some packages are missing, and installing them needs root. Type this line, then call again:"
      say "  apt-get update && apt-get install --no-install-recommends ${missing[*]}"
      exit 1
    fi
  fi
  local log
  log=$(mktemp -t gaussdrift-install.XXXXXX)
  say "installing: ${missing[*]}"
  if ! { "${as_root[@]}" apt-get update -qq &&
         "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    say "The packages could not be installed; the whole log is $log"
    exit 1
  fi
  rm -f "$log"
  reconfigure=yes  # an earlier configuration may have gone without them
}

# configure PRESET
configure() {
  local log=build/configure.log
  mkdir -p build
  if ! cmake --preset "$1" >"$log" 2>&1; then
    cat "$log" >&2
    say "Configuring failed; build/configure.log has these lines too."
    exit 1
  fi
  grep -E 'No pictures|No tests|No Python modules' "$log" >&2 || true
}

# build TARGET
build() {
  if [[ ! -f build/release/build.ninja || ${reconfigure:-no} == yes ]]; then configure release; fi
  cmake --build --preset release --target "$1" >&2
}
