#!/bin/sh
# Sets up a virtual environment, and Debian packages where it may: for `make demo` what baking and viewing need, for
# `make test` what the tests and checks need too.
# Usage: tools/setup.sh VENV demo|test
set -eu
venv=$1
purpose=$2
python=${PYTHON:-python3}

"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || {
    echo "$python is Python $("$python" -c 'import platform; print(platform.python_version())'), expected 3.11 or" \
        "later; PYTHON=python3.12 make demo takes another" >&2
    exit 1
}

missing=""
"$python" -c 'import ensurepip, venv' 2>/dev/null || missing="$missing python3-venv"
# the window needs a Vulkan driver; this package has one that runs on the CPU
find /usr/share/vulkan/icd.d /etc/vulkan/icd.d -name '*.json' 2>/dev/null | grep -q . ||
    missing="$missing mesa-vulkan-drivers"
# meshoptimizer comes as source alone
command -v c++ >/dev/null || missing="$missing g++"
"$python" -c 'import sys, sysconfig, pathlib; sys.exit(not pathlib.Path(sysconfig.get_path("include"), "Python.h").exists())' ||
    missing="$missing python3-dev"
if [ "$purpose" = test ]; then
    # the independent reader that a test holds the file format against
    command -v flatc >/dev/null || missing="$missing flatbuffers-compiler"
    # shaders come compiled, but tests compile changed ones
    command -v glslangValidator >/dev/null || missing="$missing glslang-tools"
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
fi

if [ -n "$missing" ] && command -v apt-get >/dev/null; then
    if [ "$(id -u)" = 0 ]; then as_root=""; else as_root="sudo -n"; fi
    if $as_root true 2>/dev/null; then
        echo "Installing Debian packages:$missing"
        $as_root apt-get update -q && $as_root apt-get install -y -q $missing && missing=""
    fi
fi
for package in $missing; do
    echo "Missing: $package. Install it with: sudo apt-get install $package" >&2
done
case "$missing" in *python3-venv*) exit 1 ;; esac

case "$purpose" in
demo) extras=bake,view size="1.8 GB" research="" ;;
*) extras=dev size="2.4 GB" research="-e ./python/research" ;;
esac
echo "Installing Python packages into $venv: $size, of which torch is 0.7 GB"
[ -x "$venv/bin/python" ] || "$python" -m venv "$venv"
# Compiling all modules would take longer than compiling those that are imported, when they are.
pip="$venv/bin/python -m pip install --no-compile --disable-pip-version-check"
# Without a GPU of NVIDIA's the build for the CPU, which is a tenth of the size; where it is not found, whatever pip finds.
torch=torch==2.13.0
echo "1 of 2: torch"
command -v nvidia-smi >/dev/null ||
    $pip --retries 1 --no-deps --index-url https://download.pytorch.org/whl/cpu $torch || true
$pip $torch "setuptools>=77"
echo "2 of 2: MUA and all others"
$pip -e "./python[$extras]" $research
