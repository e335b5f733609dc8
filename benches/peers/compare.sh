#!/bin/sh
# The same blocks in LAMMPS's PERI package and in this library, one thread each: prints the ratio
# of the processor times of the time loop and the largest difference of the displacements after
# 100 steps relative to the largest displacement. Ends with 1 where they disagree.
#
#   benches/peers/compare.sh            20³ nodes, a minute
#   benches/peers/compare.sh --full     64³ and 100³ nodes, most of an hour
#   benches/peers/compare.sh 32 40      edges of your own (even)
#
# Needs `lmp` (Debian's package lammps), cargo and awk. Fields go to out/peers/, 120 MB for 100³.
set -eu
cd "$(dirname "$0")/../.."
export OMP_NUM_THREADS=1
# What the rounding of positions may come to; a difference of definition is far above it.
limit=1e-11

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

# ns per directed bond and step of LAMMPS's loop of 100 steps: wall time times the share of it
# that it had the processor, over the offsets with |ξ| ≤ 3 that stay inside the block.
loop() {
    awk -v n="$2" '
        /^Loop time of .* for 100 steps/ { wall = $4 }
        wall && /% CPU use/ {
            for (x = -3; x <= 3; x++) for (y = -3; y <= 3; y++) for (z = -3; z <= 3; z++)
                if (x * x + y * y + z * z <= 9 && (x || y || z))
                    bonds += (n - (x < 0 ? -x : x)) * (n - (y < 0 ? -y : y)) * (n - (z < 0 ? -z : z))
            print 1e9 * wall * $1 / 100 / (100 * bonds)
            exit
        }' "$1"
}

echo "Processor time of the time loop on one thread, ns per directed bond and step:"
echo
echo "| model | nodes | runs | LAMMPS | lattice, damage | ratio | no damage | ratio | cloud, damage | ratio | largest difference |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
for n in $edges; do
    # LAMMPS takes minutes for large blocks.
    if [ "$n" -le 64 ]; then rounds=3; else rounds=1; fi
    for model in pmb lps; do
        field=$out/$model-$n.txt log=$out/$model-$n.log times=$out/$model-$n.times
        : >"$times"
        for round in $(seq $rounds); do
            if ! lmp -in benches/peers/block.lmp -var model $model -var n "$n" \
                -var field "$field" -log none >"$log" 2>&1; then
                tail -n 3 "$log" >&2
                exit 1
            fi
            ours=$(cargo bench --quiet --bench peers -- $model "$n" "$field")
            echo "$(loop "$log" "$n") $ours" >>"$times"
        done
        # Medians of the times and of the ratios of each round.
        awk -v name="| $model | $n³ | $rounds" -v limit=$limit '
            function median(c, i, j, t) {
                for (i = 2; i <= NR; i++)
                    for (j = i; j > 1 && x[c, j] < x[c, j - 1]; j--) {
                        t = x[c, j]; x[c, j] = x[c, j - 1]; x[c, j - 1] = t
                    }
                return x[c, int((NR + 1) / 2)]
            }
            {
                for (c = 1; c <= 4; c++) x[c, NR] = $c
                for (c = 2; c <= 4; c++) x[c + 3, NR] = $1 / $c
                difference = $5
            }
            END {
                printf "%s | %.1f", name, median(1)
                for (c = 2; c <= 4; c++) printf " | %.2f | %.1f", median(c), median(c + 3)
                printf " | %s |\n", difference
                exit !(difference + 0 <= limit + 0)
            }' "$times" || { echo "$model, $n³: the fields differ by more than $limit" >&2; exit 1; }
    done
done
