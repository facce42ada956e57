#!/usr/bin/env bash
# Installs what building, testing and running needs on Debian 12, and selects OpenBLAS. As root, or with sudo.
# Nothing is touched, and no network is used, when everything is there already.
#   scripts/install-deps.sh [--benchmarks: the libraries that the benchmarks compare with, too]
set -euo pipefail

packages=(
  # tools
  g++ cmake ninja-build ccache pkg-config python3 clang-format-14 clang-tidy-14
  # algebra
  libpetsc-real-dev libmumps-dev libsuitesparse-dev libmetis-dev libopenblas0-pthread libopenblas-pthread-dev
  # processes
  libopenmpi-dev openmpi-bin
  # finite elements, meshes, expressions
  libdeal.ii-dev libgmsh-dev libmuparser-dev libeigen3-dev
  # deck, command line, records, pictures
  libyaml-cpp-dev libcli11-dev nlohmann-json3-dev libspdlog-dev libfmt-dev zlib1g-dev
  # tests, and CGAL as an oracle of theirs
  libgtest-dev libgmock-dev libcgal-dev
)
if [ "${1:-}" = --benchmarks ]; then
  packages+=(libnanoflann-dev libembree-dev)
fi

as_root()
{
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo DEBIAN_FRONTEND=noninteractive "$@"
  else
    echo "install-deps.sh: '$*' needs root: run it as root, or install sudo" >&2
    exit 1
  fi
}

missing_packages()
{
  local known installed
  # Fails where it does not know one of them, after it has printed the others.
  known=$(dpkg-query --show --showformat '${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null || true)
  installed=$(sed -n 's/^installed //p' <<<"$known" | sort -u)
  comm -23 <(printf '%s\n' "${packages[@]}" | sort -u) <(printf '%s\n' "$installed")
}

select_openblas()
{
  local library arch wanted
  arch=$(g++ -print-multiarch)
  for library in libblas.so.3 liblapack.so.3; do
    wanted=/usr/lib/$arch/openblas-pthread/$library
    if [ "$(readlink --canonicalize "/usr/lib/$arch/$library")" != "$(readlink --canonicalize "$wanted")" ]; then
      as_root update-alternatives --set "$library-$arch" "$wanted"
    fi
  done
}

export DEBIAN_FRONTEND=noninteractive
mapfile -t missing < <(missing_packages)
if [ "${#missing[@]}" -gt 0 ]; then
  echo "installing: ${missing[*]}"
  as_root apt-get update -q
  as_root apt-get install -q -y --no-install-recommends "${missing[@]}"
fi
select_openblas
