# Every protocol of the virtual testing machine, through files and back.
. "$SOURCE/tests/cli/lib.sh"

tissue() { # tissue FILE ELASTIC MEMORY
    printf 'tissue: %s\nelastic: {%s}\nmemory: {%s}\n' "${1%.yaml}" "$2" "$3" >"$1"
}
linear='law: linear, modulus: 10 kPa'
exponential='law: exponential, B: 20, C: 10 kPa'
kelvin='law: kelvin, tau_epsilon: 0.5 s, tau_sigma: 1 s'
spectrum='law: fung-spectrum, c: 0.1, tau1: 10 ms, tau2: 100 s'
tissue a.yaml "$linear" "$kelvin"
tissue b.yaml "$exponential" "$kelvin"
tissue c.yaml "$linear" "$spectrum"
tissue d.yaml "$exponential" "$spectrum"

# hysteresis: the table of the manual is what the command gives
for name in a b c d; do
    "$SINEW" test $name.yaml --protocol hysteresis --stretch 1.2 --from "0.1 ms" --to "1e4 s" --points 9 \
        --out $name.csv --quiet
    head -n 2 $name.csv | grep -qx 'frequency \[Hz\],hysteresis \[1\]' || die "$name.csv: header"
    awk -F, 'NR > 2 { printf "%.4f\n", $2 }' $name.csv >$name.column
done
paste a.column b.column c.column d.column | awk '{ print $1, $2, $3, $4 }' >table
sed -n 's/^| [0-9.]* | \([0-9.]*\) | \([0-9.]*\) | \([0-9.]*\) | \([0-9.]*\) |$/\1 \2 \3 \4/p' \
    "$SOURCE/docs/theory/memory.md" >manual
[ "$(wc -l <manual)" = 9 ] || die "memory.md has no table of hysteresis"
diff manual table || die "the table of memory.md is not what the command gives"
"$SINEW" test c.yaml --protocol hysteresis --json >h.json
[ "$(grep -c '"hysteresis":' h.json)" = 31 ] || die "expected 31 speeds"
holds "$(number frequency_Hz <h.json) == 5"
fails 2 'takes no hold: it takes stretch, from, to, points' "$SINEW" test c.yaml --protocol hysteresis --hold "3 s"
fails 2 '--from' "$SINEW" test c.yaml --protocol hysteresis --from "3 Hz"
fails 2 'at least 3' "$SINEW" test c.yaml --protocol hysteresis --points 2

# dynamic: tan delta of the kelvin body peaks at 1/sqrt(0.5) rad/s with 0.5/(2 sqrt(0.5))
"$SINEW" test a.yaml --protocol dynamic --from "0.2250790790 Hz" --to "2 Hz" --points 3 --out e.csv --json >e.json
holds "($(number tan_delta <e.json) - 0.3535533906)^2 < 1e-18"
sed -n 3p e.csv | grep -qx 'frequency \[Hz\],storage_modulus \[Pa\],loss_modulus \[Pa\]' || die "e.csv: header"
fails 2 '--to' "$SINEW" test a.yaml --protocol dynamic --to "1 s"

# creep with recovery: a maxwell body keeps what its dashpot gave, stress (hold + ramp)/(E tau)
tissue f.yaml "$linear" 'law: maxwell, tau: 8 s'
"$SINEW" test f.yaml --protocol creep --stress "200 Pa" --ramp "0.5 s" --hold "4 s" --recovery "3 s" --points 61 \
    --out f.csv --json >f.json
holds "$(number duration_s <f.json) == 8"
[ "$(tail -n 1 f.csv | cut -d, -f1)" = 8 ] || die "f.csv: last row"
"$SINEW" analyze f.csv --test creep --out f --json >f.json
holds "($(number compliance_per_Pa <f.json) / (1e-4 * (1 + 4.25 / 8)) - 1)^2 < 1e-12"
holds "($(number creep_rate_per_s <f.json) / (0.02 / 8) - 1)^2 < 1e-12"
holds "($(number recovered_fraction <f.json) - (1 - 4.5 / 8 / (1 + 4.25 / 8)))^2 < 1e-12"
grep -q '"time_to_rupture_s": null' f.json || die "nothing broke"
[ -s f/analysis.json ] && [ -s f/report.html ] || die "f: analysis and report"
fails 1 'gives way' "$SINEW" test b.yaml --protocol creep --stress "-1 kPa"
fails 2 '--stress' "$SINEW" test b.yaml --protocol creep --stress 3
fails 2 'no column for the stretch' "$SINEW" analyze c.csv --test creep

# biaxial and shear of a neo-hookean solid without memory: mu (l - l3^2/l), mu g
printf 'tissue: n\nelastic: {law: neo-hookean, shear_modulus: 2 kPa, bulk_modulus: incompressible}\n' >n.yaml
"$SINEW" test n.yaml --protocol biaxial --stretch-1 1.25 --stretch-2 1.6 --out n.csv --json >n.json
holds "($(number peak_stress_1_Pa <n.json) / (2000 * (1.25 - 0.2)) - 1)^2 < 1e-20"
holds "($(number peak_stress_2_Pa <n.json) / (2000 * (1.6 - 0.15625)) - 1)^2 < 1e-20"
sed -n 2p n.csv | grep -qx 'time \[s\],stretch_1 \[1\],stretch_2 \[1\],stress_1 \[Pa\],stress_2 \[Pa\]' ||
    die "n.csv: header"
"$SINEW" test n.yaml --protocol shear --shear 0.7 --ramp "3 s" --out s.csv --json >s.json
holds "($(number peak_shear_stress_Pa <s.json) / 1400 - 1)^2 < 1e-20"
sed -n 2p s.csv | grep -qx 'time \[s\],shear_strain \[1\],shear_stress \[Pa\]' || die "s.csv: header"
fails 2 'a biaxial test needs a solid law' "$SINEW" test a.yaml --protocol biaxial
fails 2 'a shear test needs a solid law' "$SINEW" test a.yaml --protocol shear
fails 2 'takes no stretch' "$SINEW" test n.yaml --protocol shear --stretch 1.1
fails 2 'did you mean "biaxial"' "$SINEW" test n.yaml --protocol biaxal

# a compressible solid and a membrane go through every test; each page has its plots and the spectrum
tissue n.yaml 'law: neo-hookean, shear_modulus: 2 kPa, bulk_modulus: incompressible' "$spectrum"
tissue g.yaml 'law: neo-hookean, shear_modulus: 2 kPa, bulk_modulus: 6 kPa' "$spectrum"
tissue m.yaml 'law: fung-planar, c: 4 kPa, a1: 5, a2: 4, a3: 1, a4: 1.5' "$spectrum"
titles() { # what a page must show
    case $1 in
    tensile) echo 'Stress against stretch|Stress over time' ;;
    cyclic) echo 'Stress against stretch|Peak stress of every cycle|Hysteresis of every cycle' ;;
    creep) echo 'Strain over time|Creep compliance|Recovery' ;;
    relaxation) echo 'Stress over time|>Relaxation' ;;
    biaxial) echo 'Stress against stretch in both directions' ;;
    shear) echo 'Shear stress against shear strain' ;;
    dynamic) echo 'Dynamic moduli|Loss tangent' ;;
    hysteresis) echo 'Hysteresis against frequency' ;;
    esac | tr '|' '\n'
}
for protocol in tensile cyclic creep relaxation biaxial shear dynamic hysteresis; do
    for name in n g m; do
        report=
        [ $name = g ] && report="--report g-$protocol.html"
        "$SINEW" test $name.yaml --protocol $protocol --out $name-$protocol.csv $report --quiet
        [ -s $name-$protocol.csv ] || die "$name-$protocol.csv is missing"
    done
    { titles $protocol; echo 'Spectrum'; } | while read -r title; do
        grep -qF -- "$title" g-$protocol.html || die "the page of $protocol does not show \"$title\""
    done
    "$SINEW" test --help | grep -q "$protocol" || die "--help does not know $protocol"
    grep -q "^| $protocol |" "$SOURCE/docs/guide/commands.md" || die "commands.md does not know $protocol"
done
cmp -s n-biaxial.csv g-biaxial.csv && die "a compressible solid is not an incompressible one"
"$SINEW" test a.yaml --replay "$SOURCE/data/cardiac-muscle/ramp-1s.csv" --report replay.html --quiet
grep -q 'measured' replay.html || die "the page of a replay has no measured curve"
fails 2 'nowhere/page.html' "$SINEW" test a.yaml --protocol tensile --report nowhere/page.html

# cyclic: both waves, two cycles each
for wave in triangle sine; do
    "$SINEW" test a.yaml --protocol cyclic --wave $wave --cycles 2 --out $wave.csv --quiet
    "$SINEW" analyze $wave.csv --test cyclic --json | grep -c '"hysteresis":' | grep -qx 2 || die "$wave: cycles"
done
# preconditioning: the numbers go on, the peaks settle, the record says so
"$SINEW" test d.yaml --protocol cyclic --stretch 1.15 --lower 1.05 --cycles 4 --out fresh.csv --json >fresh.json
"$SINEW" test d.yaml --protocol cyclic --stretch 1.15 --lower 1.05 --cycles 4 --precondition 10 --out late.csv --json >late.json
[ "$(number cycle <fresh.json)" = 1 ] && [ "$(number cycle <late.json)" = 11 ] || die "numbers of the cycles"
holds "$(number peak_change <fresh.json) < 4 * $(number peak_change <late.json) && $(number peak_change <late.json) < 0"
grep -qx '# preconditioning: 10 cycles before the first row' late.csv || die "late.csv: remark"
[ "$(tail -n 1 late.csv | cut -d, -f4)" = 14 ] || die "late.csv: last cycle"
fails 2 '--precondition' "$SINEW" test a.yaml --protocol cyclic --precondition 0
fails 2 'takes no precondition' "$SINEW" test a.yaml --protocol tensile --precondition 3
fails 2 'nothing would move' "$SINEW" test a.yaml --protocol cyclic --lower 1.1
cmp -s triangle.csv sine.csv && die "a sine is no triangle"
fails 2 'did you mean "sine"' "$SINEW" test a.yaml --protocol cyclic --wave sin
fails 2 'takes no wave' "$SINEW" test a.yaml --protocol shear --wave sine
