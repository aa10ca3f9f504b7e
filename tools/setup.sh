#!/bin/sh
# Sets up what `make demo` and `make test` need: Debian packages where it may, a virtual environment always.
# Usage: tools/setup.sh VENV
set -eu
venv=$1
python=${PYTHON:-python3}

# command:package pairs; flatc is the independent reader that a test holds the file format against
missing=""
"$python" -c 'import ensurepip, venv' 2>/dev/null || missing="$missing python3-venv"
command -v flatc >/dev/null || missing="$missing flatbuffers-compiler"
# shaders come compiled, but tests compile changed ones; a Vulkan driver (this package has one that runs on the CPU)
command -v glslangValidator >/dev/null || missing="$missing glslang-tools"
find /usr/share/vulkan/icd.d /etc/vulkan/icd.d -name '*.json' 2>/dev/null | grep -q . ||
    missing="$missing mesa-vulkan-drivers"
# a character's own mesh is drawn by OpenGL without a display (this driver runs on the CPU)
find /usr/lib /lib -name 'libEGL.so.1' 2>/dev/null | grep -q . || missing="$missing libegl1"
find /usr/lib /lib -name 'swrast_dri.so' -o -name 'libgallium*.so' 2>/dev/null | grep -q . ||
    missing="$missing libgl1-mesa-dri"
# the Unity package's C# is compiled and run without Unity
command -v mcs >/dev/null || missing="$missing mono-mcs"
command -v mono >/dev/null || missing="$missing mono-runtime"
# the interactive player is tested on a display that is not there
command -v Xvfb >/dev/null || missing="$missing xvfb"
find /usr/lib /lib -name libXext.so.6 2>/dev/null | grep -q . || missing="$missing libxext6"

if [ -n "$missing" ] && command -v apt-get >/dev/null; then
    if [ "$(id -u)" = 0 ]; then as_root=""; else as_root="sudo -n"; fi
    if $as_root true 2>/dev/null; then
        $as_root apt-get update -q && $as_root apt-get install -y -q $missing && missing=""
    fi
fi
for package in $missing; do
    echo "Missing: $package. Install it with: sudo apt-get install $package" >&2
done
case "$missing" in *python3-venv*) exit 1 ;; esac

[ -x "$venv/bin/python" ] || "$python" -m venv "$venv"
# torch by itself first: asked for by another package, pip may choose a build for a GPU that is not there
"$venv/bin/python" -m pip install -q "torch==2.13.0"
"$venv/bin/python" -m pip install -q -e "./python[dev]"
