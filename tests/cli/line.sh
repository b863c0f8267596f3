# The main job on real measurements, with the figures it must reach.
. "$SOURCE/tests/cli/lib.sh"

data=$SOURCE/data/cardiac-muscle
ramps="$data/ramp-0.1s.csv $data/ramp-1s.csv $data/ramp-10s.csv $data/ramp-100s.csv"

# one law and one memory for four speeds: R2 at least 0.97, every speed predicted from the others
# within 6 % of its peak
"$SINEW" fit $ramps --elastic exponential --memory fung-spectrum --hold-out --out fit --json >fit.json
holds "$(number r_squared <fit.json) >= 0.97"
sed -n '/"held_out"/,$p' fit.json | sed -n 's/.*"rmse_over_peak": \([0-9.e-]*\).*/\1/p' >held_out
[ "$(wc -l <held_out)" = 4 ] || die "expected four held-out predictions"
while read -r error; do holds "$error <= 0.06"; done <held_out
grep -q '"identifiable": false' fit.json || die "the data do not determine every constant"
for file in fit.json tissue.yaml report.html; do [ -s "fit/$file" ] || die "fit/$file is missing"; done

# the tissue file reads back, and replays the curve it came from with the error of the fit
"$SINEW" test fit/tissue.yaml --replay "$data/ramp-10s.csv" --json >replay.json
holds "$(number rmse_over_peak <replay.json) < 0.05"

# the solid that both engines carry
"$SINEW" fit $ramps --elastic demiray --memory fung-spectrum --density "1060 kg/m3" --bulk-ratio 1000 \
    --out muscle --json >muscle.json
holds "$(number r_squared <muscle.json) >= 0.97"

# a cyclic test through the machine and back through the analysis
"$SINEW" test muscle/tissue.yaml --protocol cyclic --stretch 1.2 --ramp "0.5 s" --cycles 3 --out cyclic.csv \
    --quiet
"$SINEW" analyze cyclic.csv --test cyclic --json >cyclic.json
[ "$(grep -c '"hysteresis":' cyclic.json)" = 3 ] || die "expected three cycles"
