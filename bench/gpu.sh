#!/bin/sh
# The raster stage on a GPU, as one command for a bare machine: Linux, an NVIDIA driver with EGL, Python, and no network.
#
#     bench/gpu.sh --list                     prints how to fill the folder of wheels, on a machine with a network
#     bench/gpu.sh WHEELS                     from a checkout: at most 6 minutes, tables on standard output
#     bench/gpu.sh --allow-software WHEELS    by the processor too, to try this script; --quick: with small images
#
# PYTHON names the interpreter [python3]. Exits with 0 where all held; 2 on wrong usage; 3 where there is no GPU.
set -eu
cd "$(dirname "$0")/.."

PYTHON=${PYTHON:-python3}
SECONDS_FOR_TESTS=120
SECONDS_FOR_FRAMES=60
SECONDS_FOR_CHECKS=150

usage() {
    sed -n '1d; /^#/!q; s/^# \{0,1\}//p' bench/gpu.sh
}

list() {
    echo "# On a machine with a network, in this checkout; 3.12 is the Python of the machine with the GPU:"
    echo "python3 -m pip wheel --no-deps --wheel-dir WHEELS ."
    "$PYTHON" - <<'EOF'
import re
import tomllib

with open("pyproject.toml", "rb") as file:
    project = tomllib.load(file)["project"]
wanted = [re.sub(r"\s", "", name) for name in ("pip", *project["dependencies"], *project["optional-dependencies"]["test"])]
platforms = " ".join(f"--platform manylinux{name}_x86_64" for name in ("_2_28", "_2_17", "2014"))
print(f"python3 -m pip download --dest WHEELS --only-binary :all: --python-version 3.12 {platforms} \\")
print("    " + " ".join(f"'{name}'" for name in wanted))
EOF
}

software=
wheels=
tests=tests/raster
sizes="2048x1000 4096x10000"
samples=2048
for argument; do
    case $argument in
        --list) list; exit 0 ;;
        -h | --help) usage; exit 0 ;;
        --allow-software) software=$argument ;;
        --quick) tests="tests/raster/test_renderers.py -k opengl"; sizes="256x24 512x100"; samples=128 ;;
        -*) echo "gpu.sh: unknown option $argument; see bench/gpu.sh --help" >&2; exit 2 ;;
        *) wheels=$argument ;;
    esac
done
pip=$(ls "$wheels"/pip-*.whl 2> /dev/null | head -n 1)
if [ -z "$wheels" ] || [ -z "$pip" ]; then
    echo "gpu.sh: name the folder of wheels; bench/gpu.sh --list says how to fill it" >&2
    exit 2
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' HUP INT PIPE TERM

# A container may have the driver's library without the file that tells EGL of it.
if [ -z "${__EGL_VENDOR_LIBRARY_FILENAMES:-}" ] && [ -z "$(find /usr/share/glvnd /etc/glvnd -name '*nvidia*.json' 2> /dev/null)" ] \
    && ldconfig -p 2> /dev/null | grep -q libEGL_nvidia.so.0; then
    echo '{"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_nvidia.so.0"}}' > "$work/nvidia.json"
    export __EGL_VENDOR_LIBRARY_FILENAMES="$work/nvidia.json"
fi

# Nothing of what the machine has is taken, which may be of any age, not even its pip: there may be none.
"$PYTHON" -m venv --without-pip "$work/env"
"$work/env/bin/python" "$pip/pip" install --quiet --no-index --find-links "$wheels" "voronoi-tiles[test]"
python="$work/env/bin/python"

"$python" bench/gpu.py --only device ${software:+"$software"}

failed=0
echo
echo "Tests of the raster stage (OpenGL required):"
# -P: else the folder voronoi_tiles/ of the checkout would stand before the installed package.
# shellcheck disable=SC2086 # words of ours
VORONOI_TILES_REQUIRE_GL=1 timeout "$SECONDS_FOR_TESTS" "$python" -P -m pytest -q -p no:cacheprovider -n auto $tests \
    > "$work/tests.txt" 2>&1 || failed=1
if [ "$failed" = 1 ]; then
    cat "$work/tests.txt"
fi
tail -n 1 "$work/tests.txt"

# shellcheck disable=SC2086 # same
timeout "$SECONDS_FOR_FRAMES" "$python" bench/raster.py --only frame --sizes $sizes || failed=1
echo
echo "Hoped for: frames of 2 ms for 2048 x 2048 samples of 1,000 segments, of 20 ms for 4096 x 4096 of 10,000."
timeout "$SECONDS_FOR_CHECKS" "$python" bench/gpu.py --samples "$samples" ${software:+"$software"} || failed=1
exit "$failed"
