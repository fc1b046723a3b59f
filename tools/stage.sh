# shellcheck shell=bash
# Sourced by the scripts beside it: where the project is, timing, the log, and one build or test at a time.

shopt -s inherit_errexit
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd -P)
export LC_ALL=C.UTF-8 # the scripts read what other programs print
trap 'exit 130' INT

# complain MESSAGE...: one line on standard error.
complain() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }

# bad_usage MESSAGE...: ends the script as for every wrong command line.
bad_usage() {
    complain "$* (see --help)"
    exit 2
}

# print_help: the script's own opening comment, up to its first empty line.
print_help() { sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; }

now() { printf '%s' "$EPOCHREALTIME"; }

# seconds_since START: elapsed time with one decimal.
seconds_since() { awk -v a="$1" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f s", b - a }'; }

# logged COMMAND...: its output goes to the file $log, and to the terminal too if $verbose is yes.
logged() {
    if [[ ${verbose:-no} == yes ]]; then
        "$@" 2>&1 | tee -a "$log"
    else
        "$@" >>"$log" 2>&1
    fi
}

# hold FILE: waits until no other run holds FILE, then holds it until this script ends.
hold() {
    command -v flock >/dev/null || return 0
    exec 9>"$1"
    if ! flock -n 9; then
        complain "waiting for another run that holds $1"
        flock 9
    fi
}
