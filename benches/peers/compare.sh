#!/bin/sh
# The same blocks in LAMMPS's PERI package and in this library, one thread each: prints the ratio
# of the processor times of the time loop and the largest difference of the displacements after
# 100 steps relative to the largest displacement. Ends with 1 where they disagree.
#
#   benches/peers/compare.sh            20³ nodes, a minute
#   benches/peers/compare.sh --full     64³ and 100³ nodes, an hour
#   benches/peers/compare.sh 32 40      edges of your own (even)
#
# Needs `lmp` (Debian's package lammps), cargo and awk. Fields go to out/peers/, 120 MB for 100³.
set -eu
cd "$(dirname "$0")/../.."
export OMP_NUM_THREADS=1
# What the rounding of positions may come to; a difference of definition is far above it.
limit=1e-11
# Ratios are medians of this many runs of both; LAMMPS runs once above 64³, where it takes minutes.
rounds=3

case "${1-}" in
    '') edges=20 ;;
    --full) edges='64 100' ;;
    *) edges=$* ;;
esac
if ! command -v lmp >/dev/null; then
    echo "lmp is not there: install LAMMPS with its PERI package (Debian: apt-get install lammps)" >&2
    exit 1
fi
out=out/peers
mkdir -p "$out"
cargo bench --quiet --no-run --bench peers

# Processor seconds of LAMMPS's loop of 100 steps: wall time times the share it had the processor.
loop() {
    awk '/^Loop time of .* for 100 steps/ { wall = $4 } wall && /% CPU use/ { sub("%", "", $1);
        print wall * $1 / 100; exit }' "$1"
}
median() {
    printf '%s\n' "$@" | sort -g | awk '{ x[NR] = $1 } END { print x[int((NR + 1) / 2)] }'
}
ratio() {
    awk -v a="$1" -v b="$2" 'BEGIN { printf "%.1f", a / b }'
}

echo "CPU s of 100 steps on one thread (ns per directed bond and step), medians of $rounds"
echo
echo "| model | nodes | LAMMPS | with damage | ratio | without damage | ratio | largest difference |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
status=0
for n in $edges; do
    for model in pmb lps; do
        field=$out/$model-$n.txt log=$out/$model-$n.log
        theirs='' with='' without='' faster='' bare_faster='' ns='' bare_ns='' ns_theirs=''
        for round in $(seq $rounds); do
            if [ "$round" = 1 ] || [ "$n" -le 64 ]; then
                if ! lmp -in benches/peers/block.lmp -var model $model -var n "$n" \
                    -var field "$field" -log none >"$log" 2>&1; then
                    tail -n 3 "$log" >&2
                    exit 1
                fi
            fi
            lammps=$(loop "$log")
            ours=$(cargo bench --quiet --bench peers -- $model "$n" "$field")
            set -- $ours
            theirs="$theirs $lammps" with="$with $1" without="$without $2"
            ns="$ns $3" bare_ns="$bare_ns $4" difference=$5
            ns_theirs="$ns_theirs $(awk -v t="$lammps" -v a="$1" -v b="$3" 'BEGIN { print t / a * b }')"
            faster="$faster $(ratio "$lammps" "$1")"
            bare_faster="$bare_faster $(ratio "$lammps" "$2")"
        done
        printf '| %s | %s³ | %.2f (%.1f) | %.3f (%.2f) | %s | %.3f (%.2f) | %s | %s |\n' \
            $model "$n" "$(median $theirs)" "$(median $ns_theirs)" \
            "$(median $with)" "$(median $ns)" "$(median $faster)" \
            "$(median $without)" "$(median $bare_ns)" "$(median $bare_faster)" "$difference"
        if awk -v d="$difference" -v l=$limit 'BEGIN { exit d + 0 <= l + 0 }'; then
            echo "$model, $n³: fields differ by $difference, more than $limit" >&2
            status=1
        fi
    done
done
exit $status
