#!/usr/bin/env bash
# Counts the instructions of six runs by callgrind and compares them with those on record: tests/instructions.sh PROGRAM [--record]
#
# A count over 103 % of the recorded one fails where compiler, valgrind, C library and processor are those of the record, and is only
# reported elsewhere. With --record the counts found take the place of the old ones; build with CARGO_INCREMENTAL=0 before, as
# continuous integration does.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
program=$1 mode=${2-} record=tests/instructions.txt most=103

# a row of $1 four-bars, and a chain of $1 rods
row() {
    awk -v n="$1" 'BEGIN {
        print "grashof: 1\nname: row\nspace: planar\ngravity: [0, -9.81 m/s^2]\nground:"
        for (i = 0; i <= n; i++) printf "  G%d: [%d m, 0 m]\n", i, i
        print "bodies:"
        for (i = 0; i <= n; i++) printf "  v%d: { bar: { length: 1 m, mass: 1 kg } }\n", i
        for (i = 0; i < n; i++) printf "  h%d: { bar: { length: 1 m, mass: 1 kg } }\n", i
        print "joints:"
        for (i = 0; i <= n; i++) printf "  A%d: { revolute: [ground.G%d, v%d.start] }\n", i, i, i
        for (i = 0; i < n; i++) printf "  B%d: { revolute: [v%d.end, h%d.start] }\n  C%d: { revolute: [h%d.end, v%d.end] }\n", i, i, i, i, i, i + 1
        print "start:\n  A0.angle: 90 deg\n  A0.omega: 1 rad/s"
        for (i = 1; i <= n; i++) printf "  A%d.angle: ~90 deg\n", i
        print "studies: { it: { dynamics: { until: 0.1 s, every: 0.1 s, tolerance: 1e-6 }, columns: [A0.angle] } }"
    }'
}
chain() {
    awk -v n="$1" 'BEGIN {
        print "grashof: 1\nname: chain\nspace: planar\ngravity: [0, -9.81 m/s^2]\nbodies:"
        for (i = 0; i < n; i++) printf "  b%d: { bar: { length: 0.1 m, mass: 1 kg } }\n", i
        print "joints:\n  J0: { revolute: [ground, b0.start] }"
        for (i = 1; i < n; i++) printf "  J%d: { revolute: [b%d.end, b%d.start] }\n", i, i - 1, i
        print "studies: { it: { dynamics: { until: 10 ms, every: 10 ms, tolerance: 1e-6, integrator: bdf }, columns: [J0.angle] } }"
    }'
}

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
row 40 >"$work/row.yaml"
chain 140 >"$work/chain.yaml"

# count MODEL STUDY: instructions, thousands
count() {
    local said
    said=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" run "$1" --study "$2" --no-plots --no-report -q -j 1 -o "$work/out" 2>&1 >/dev/null) ||
        { printf '%s\n' "$said" >&2; return 1; }
    awk '/Collected/ { printf "%d", $4 / 1000 }' <<<"$said"
}

# what is compiled, and by what it is counted, decide on the count as well; an incremental build is cut into other pieces
processor=$(awk -F': *' '/^model name|^model\t|^cpu family/ { sub(/[ \t]+$/, "", $1); if (!seen[$1]++) printf "%s%s", sep, $2; sep = " " }' /proc/cpuinfo)
libc=$(ldd --version 2>/dev/null | head -n 1 | awk '{ print $NF }')
pieces=$([ "${CARGO_INCREMENTAL-}" = 0 ] && echo whole || echo incremental)
machine="$(rustc --version), $pieces, $(valgrind --version), glibc $libc, processor $processor"
recorded=$(sed -n 's/^machine: //p' "$record" 2>/dev/null)
[ "$machine" = "$recorded" ] && same=yes || same=

failed=
found="machine: $machine"
while read -r name model study; do
    now=$(count "$model" "$study") || exit 1
    found="$found"$'\n'"$name $now"
    before=$(awk -v name="$name" '$1 == name { print $2 }' "$record" 2>/dev/null)
    part=$(awk -v now="$now" -v before="${before:-$now}" 'BEGIN { printf "%.1f", 100 * now / before }')
    printf '  %-14s %9d thousand instructions, %s %% of the record\n' "$name" "$now" "$part"
    awk -v part="$part" -v most="$most" 'BEGIN { exit !(part > most) }' && failed="$failed $name"
done <<TABLE
one-turn models/crank_rocker.yaml one-turn
start-up models/crank_rocker.yaml start-up
andrews models/andrews.yaml squeeze
heavy-top models/heavy_top.yaml nutation
row $work/row.yaml it
chain $work/chain.yaml it
TABLE

if [ "$mode" = --record ]; then
    { sed -n '/^#/p' "$record"; printf '%s\n' "$found"; } >"$work/record" && cp "$work/record" "$record"
elif [ -n "$failed" ] && [ -n "$same" ]; then
    printf 'more than %s %% of the record:%s; make it faster, or record it with its reason: tests/instructions.sh PROGRAM --record\n' "$most" "$failed" >&2
    exit 1
elif [ -z "$same" ]; then
    printf '  recorded elsewhere (%s): reported only\n' "$recorded"
fi
