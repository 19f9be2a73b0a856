# Sourced by ./run and ./test: sees to it that what they need at build and run time is there.
# Everything is either found, installed through apt (as root or with passwordless sudo), or asked for in one sentence.

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo -n "$@"; fi
}

can_install() {
  command -v apt-get >/dev/null 2>&1 || return 1
  [ "$(id -u)" = 0 ] || sudo -n true >/dev/null 2>&1
}

# need WHAT PACKAGE...: installs the packages, or says that they are needed.
need() {
  what=$1
  shift
  if can_install; then
    echo "Installing $* ($what)." >&2
    if [ -z "${TOUCHSTONE_APT_UPDATED:-}" ]; then
      as_root apt-get update -qq >&2 || true
      TOUCHSTONE_APT_UPDATED=1
    fi
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null 2>&1 && return 0
  fi
  echo "Please install $* ($what); it could not be installed from here." >&2
  return 1
}

have_library() {
  { ldconfig -p 2>/dev/null || /sbin/ldconfig -p 2>/dev/null; } | grep -q "$1"
}

have_vulkan() {
  have_library 'libvulkan\.so\.1' || return 1
  for folder in /usr/share/vulkan/icd.d /etc/vulkan/icd.d "${XDG_DATA_HOME:-$HOME/.local/share}/vulkan/icd.d"; do
    for driver in "$folder"/*.json; do
      [ -e "$driver" ] && return 0
    done
  done
  [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ]
}

setup_build() {
  if ! command -v cargo >/dev/null 2>&1 && [ -f "$HOME/.cargo/env" ]; then . "$HOME/.cargo/env"; fi
  if ! command -v cargo >/dev/null 2>&1; then
    echo "Please install Rust first (rustup.rs): cargo was not found." >&2
    exit 1
  fi
  if ! command -v cc >/dev/null 2>&1; then need "a linker" gcc libc6-dev || exit 1; fi
}

# Pictures work without it only where a graphics card brings its own driver.
setup_pictures() {
  have_vulkan || need "software Vulkan, for pictures" libvulkan1 mesa-vulkan-drivers || true
  if [ -z "${XDG_RUNTIME_DIR:-}" ]; then
    XDG_RUNTIME_DIR=$(mktemp -d)
    chmod 700 "$XDG_RUNTIME_DIR"
    export XDG_RUNTIME_DIR
  fi
}

setup_window() {
  if [ -n "${DISPLAY:-}" ] && ! have_library 'libxkbcommon-x11\.so\.0'; then
    need "the window under X11" libxkbcommon-x11-0 libxcursor1 libxi6 || true
  fi
}

# A screen in memory, and hands to drive a window on it; without them that test is skipped, with a word.
setup_real_window() {
  if ! command -v Xvfb >/dev/null 2>&1 || ! command -v xdotool >/dev/null 2>&1; then
    need "a window that the tests drive" xvfb xdotool || true
  fi
  if ! have_library 'libxkbcommon-x11\.so\.0'; then
    need "the window under X11" libxkbcommon-x11-0 libxcursor1 libxi6 || true
  fi
}

# Videos of the hand are read by it; without it those tests are skipped, with a word, and the window says what to install.
setup_video() {
  command -v ffmpeg >/dev/null 2>&1 || need "videos of the hand" ffmpeg || true
}

# Headers for the features that the default build leaves out; false where they cannot be had. `./test` only checks those features.
setup_features() {
  have_headers || need "headers for sound and gamepads, to check these features" pkg-config libasound2-dev libudev-dev || return 1
  have_headers
}

have_headers() {
  command -v pkg-config >/dev/null 2>&1 && pkg-config --exists alsa libudev
}

# MuJoCo, Drake, matplotlib and jsonschema for the tests beside other programs, in an environment of their own under the build folder, which sees what is
# installed besides; without them those tests are skipped, with a word.
setup_python() {
  [ -z "${TOUCHSTONE_PYTHON:-}" ] || return 0
  if ! command -v python3 >/dev/null 2>&1; then
    echo "There is no python3 here: tests beside MuJoCo and of the Python example are skipped." >&2
    return 0
  fi
  environment=${CARGO_TARGET_DIR:-target}/python
  [ ! -e "$environment/ready" ] || return 0
  echo "Installing MuJoCo and matplotlib for the tests, into $environment." >&2
  if python3 -m venv --system-site-packages "$environment" >/dev/null 2>&1 &&
    "$environment/bin/pip" install --quiet --disable-pip-version-check mujoco matplotlib jsonschema >/dev/null 2>&1; then
    touch "$environment/ready"
    # Not for every system and version of Python; the test that wants it says so.
    "$environment/bin/pip" install --quiet --disable-pip-version-check drake >/dev/null 2>&1 || true
  else
    rm -rf "$environment"
    echo "It could not be installed from here (python3-venv and PyPI are needed): tests beside MuJoCo are skipped." >&2
  fi
}
