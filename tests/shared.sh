# Settings and functions shared by `ci` and tests/*/run.

# The verbs share these target directories. cargo locks a target directory during a build, so checks have their own.
target=${CARGO_TARGET_DIR:-$PWD/target}
checks=$target/check
# CI builds exactly the lock files, and draws the same random cases each time.
locked=()
if [[ ${CI:-} == true ]]; then
    locked=(--locked)
    export PROPTEST_RNG_SEED=${PROPTEST_RNG_SEED:-20261123}
fi

say() { printf '\n== %s\n' "$*"; }
fail() { printf 'ci: %s\n' "$*" >&2; exit 1; }
# A missing tool fails in CI. On other machines the check is skipped with a message.
skip() {
    [[ ${CI:-} != true ]] || fail "$*, and in CI nothing is skipped"
    printf 'skipped: %s\n' "$*"
}
has() {
    local tool
    for tool in "$@"; do command -v "$tool" >/dev/null || return 1; done
}
has_pip() { [[ ${CI:-} == true ]] || python3 -m pip --version >/dev/null 2>&1; }
pip_install() { has_pip && python3 -m pip install --quiet --only-binary :all: "$@"; }

# The libraries, and the features of one of them.
libraries=(farsa-num farsa-body farsa-physics farsa-nn farsa-evo farsa-models farsa-view farsa-lab farsa-compose farsa-original farsa-experiments farsa)
features_of() {
    local folder=$1
    [[ $1 != farsa ]] || folder=.
    awk '/^\[/ { within = $0 == "[features]" } within && /^[a-z]/ && $1 != "default" { print $1 }' "$folder/Cargo.toml"
}

# Targets without an operating system.
bare=(thumbv6m-none-eabi thumbv7em-none-eabihf riscv32imac-unknown-none-elf wasm32-unknown-unknown)

for_boards() {
    has "$@" || { skip "$*: one of them is not installed, no board is run"; return 1; }
}
# Compares a line of a board's output with firmware/golden.txt: BOARD NAME OUTPUT [STEPS].
same_line() {
    local golden
    golden=$(sed -n "s/^$2 \(${4:-100000} \)\?\([0-9a-f]\{16\}\)\$/\2/p" firmware/golden.txt)
    [[ $(sed -n "s/^$2 //p" <<<"$3") == "$golden" ]] || fail "$1: $2 is not $golden"
}
# Compares a number in a board's output with a limit: BOARD NAME OUTPUT LIMIT.
at_most() {
    local value
    value=$(sed -n "s/^$2 //p" <<<"$3")
    [[ -n $value ]] && ((value <= $4)) || fail "$1: $2 is ${value:-missing}, at most $4"
}
at_least() {
    local value
    value=$(sed -n "s/^$2 //p" <<<"$3")
    [[ -n $value ]] && ((value >= $4)) || fail "$1: $2 is ${value:-missing}, at least $4"
}
