# Sourced by contrib/limber and contrib/check*: installs what is missing on
# Debian, configures and builds. Says nothing when nothing needs doing.
#
# Expects 'set -euo pipefail', and in preset which one of CMakePresets.json is
# built, release by default. Sets root (the project) and build (the folder of
# that build).

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$root/build/${preset:=release}

compilers=(g++ cmake ninja-build ccache)
libraries=(libdeal.ii-dev libpng-dev libgtest-dev
  python3-numpy python3-matplotlib python3-h5py)

# Both for mpirun in a container, and for more ranks than cores.
if [[ $(id -u) == 0 ]]; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
export OMPI_MCA_rmaps_base_oversubscribe=${OMPI_MCA_rmaps_base_oversubscribe:-1}
export OMPI_MCA_hwloc_base_binding_policy=${OMPI_MCA_hwloc_base_binding_policy:-none}

fail() {
  echo "$*" >&2
  exit 1
}

# Runs a command with its output in a log, which is shown if it fails.
quietly() {
  local log=$1
  shift
  "$@" >"$log" 2>&1 && return
  cat "$log" >&2
  fail "'$*' failed; what it said is above and in $log."
}

# missing PACKAGE...: those which are not installed.
missing() {
  local package
  for package in "$@"; do
    [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == \
      installed ]] || echo "$package"
  done
}

install_packages() {
  local log as_root=()
  if [[ $(id -u) != 0 ]]; then
    command -v sudo >/dev/null || fail "Missing: $*." \
      "Installing them needs root: apt-get install $*"
    as_root=(sudo)
  fi
  log=$(mktemp)
  quietly "$log" "${as_root[@]}" apt-get update
  quietly "$log" "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --no-install-recommends "$@"
  rm "$log"
}

# While packages are unpacked the processor has little to do. What goes wrong
# here is said by the build that follows.
compile_kernels() {
  cmake -S "$root" --preset "$preset" -DLIMBER_KERNELS_ONLY=ON &&
    nice cmake --build "$build" --parallel "$(jobs_that_fit)"
}

install_missing() {
  # Elsewhere CMake says what is missing.
  command -v dpkg-query apt-get >/dev/null || return 0

  local tools wanted kernels
  mapfile -t tools < <(missing "${compilers[@]}")
  mapfile -t wanted < <(missing "${libraries[@]}")
  if [[ ${#tools[@]} != 0 ]]; then
    echo "Installing ${tools[*]}"
    install_packages "${tools[@]}"
  fi
  if [[ ${#wanted[@]} != 0 ]]; then
    echo "Installing ${wanted[*]} (deal.II takes a minute or more)"
    compile_kernels >/dev/null 2>&1 &
    kernels=$!
    install_packages "${wanted[@]}"
    wait "$kernels" || true
  fi
}

# As many compilers as there are cores, at 1.5 GB each.
jobs_that_fit() {
  local cores memory
  cores=$(nproc)
  memory=$(awk '/^MemAvailable/ {print int($2 / 1500000)}' /proc/meminfo)
  ((memory < 1)) && memory=1
  echo $((memory < cores ? memory : cores))
}

# Says that a compiler is at work, and how far it has come: on a terminal in one
# line that changes, else once a minute.
announce_building() {
  local line said= started=$SECONDS last=$SECONDS now
  while read -r line; do
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] || continue
    if [[ -z $said && $line == *"Building CXX"* ]]; then
      echo "Building Limber, some minutes the first time; see $1"
      said=yes
    fi
    [[ -n $said ]] || continue
    now="  ${BASH_REMATCH[1]} of ${BASH_REMATCH[2]} steps after $((SECONDS - started)) s"
    if [[ -t 1 ]]; then
      printf '\r%s' "$now"
    elif ((SECONDS - last >= 60)); then
      echo "$now"
      last=$SECONDS
    fi
  done
  [[ -z $said || ! -t 1 ]] || echo
}

# prepare [target...]: everything if no target is named.
prepare() {
  local log=$build/build.log
  install_missing
  mkdir -p "$build"
  if [[ ! -e $build/build.ninja ]] ||
    grep -q LIMBER_KERNELS_ONLY:BOOL=ON "$build/CMakeCache.txt"; then
    echo "Configuring Limber in $build"
    quietly "$build/configure.log" cmake -S "$root" --preset "$preset" \
      -DLIMBER_KERNELS_ONLY=OFF
  fi
  cmake --build "$build" --parallel "$(jobs_that_fit)" ${1:+--target "$@"} 2>&1 |
    tee "$log" | announce_building "$log" && return
  cat "$log" >&2
  fail "The build failed; what it said is above and in $log."
}
