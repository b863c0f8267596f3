# Curves of two directions through the command: analyze, fit, refusals.
. "$SOURCE/tests/cli/lib.sh"

data=$SOURCE/data/pericardium

# the paired tables are what the script makes of the digitised curves
if command -v python3 >/dev/null; then
    mkdir copy
    cp -r "$data/prepare.py" "$data/digitised" copy
    python3 copy/prepare.py
    for table in copy/protocol-*.csv; do
        diff "$table" "$data/${table#copy/}" || die "$table is another one"
    done
fi

"$SINEW" analyze "$data/protocol-1-1.csv" --test biaxial --out analysis --json >analysis.json
# T1 = T2 by the pairing; the last row of E11-S11 is 1089.1 kPa at 0.0978
holds "($(number stress_ratio <analysis.json) - 1)^2 < 1e-6"
holds "($(number peak_stress_1_Pa <analysis.json) / (1089.1e3 * sqrt(1.1956)) - 1)^2 < 1e-8"
holds "$(number anisotropy <analysis.json) > 0.5"
holds "$(number high_modulus_2_Pa <analysis.json) > 10 * $(number low_modulus_2_Pa <analysis.json)"
grep -q 'axis 2' analysis/report.html || die "the page has no second axis"

"$SINEW" fit "$data"/protocol-*.csv --elastic fung-planar --hold-out --out fit --json >fit.json
holds "$(number r_squared <fit.json) > 0.965"
grep -q '"convex": true' fit.json || die "expected a convex fit"
grep -q '"window": null' fit.json || die "expected no window without time"
[ "$(grep -c '"kind": "biaxial"' fit.json)" = 3 ] || die "expected three biaxial curves"
[ "$(grep -o 'stretch of the axis' fit/report.html | wc -l)" -ge 6 ] || die "expected six biaxial plots"
grep -q 'law: fung-planar' fit/tissue.yaml || die "no tissue"

# one ratio: no constants, and the reason. Equation (21) with c = 2 kPa, a1 = 19, a2 = 11, a4 = 4
awk 'BEGIN {
    print "green_strain_1 [1],pk2_stress_1 [kPa],green_strain_2 [1],pk2_stress_2 [kPa]"
    for (i = 0; i <= 30; i++) {
        e = 0.2 * i / 30; x = 2 * exp(38 * e * e)
        printf "%.9f,%.9f,%.9f,%.9f\n", e, x * 23 * e, e, x * 15 * e
    }
}' >planar.csv
"$SINEW" fit planar.csv --elastic fung-planar --json >one.json
grep -q '"identifiable": false' one.json || die "one ratio cannot identify"
grep -q 'one loading ratio: E22/E11 is 1 throughout, only a1 +1 a4 and a2 +1 a4 are known' one.json ||
    die "no reason"
"$SINEW" test "$SOURCE/tests/cli/biaxial.yaml" --protocol biaxial --stretch-1 1.2 --stretch-2 1.2 --out one.csv --quiet
"$SINEW" fit one.csv --elastic fung --fix a3=5 --fix a5=1 --fix a6=2 --json >fung.json
[ "$(grep -c '"fixed": true' fung.json)" = 7 ] || die "three held, three tied, and the bulk modulus"
fails 2 'neither law' "$SINEW" fit one.csv --elastic fung --fix b3=5

# shear
"$SINEW" test "$SOURCE/tests/cli/biaxial.yaml" --protocol shear --shear 0.3 --out shear.csv --quiet
"$SINEW" fit shear.csv one.csv --elastic neo-hookean --out mixed --quiet
grep -q 'Shear stress against shear strain' mixed/report.html || die "no shear plot"
grep -q '"convex": null' mixed/fit.json || die "only Fung laws are asked"

# refusals
for test in tensile cyclic creep relaxation; do
    fails 2 "a biaxial curve" "$SINEW" analyze one.csv --test $test
done
fails 2 'a shear curve: a biaxial test needs a biaxial one' "$SINEW" analyze shear.csv --test biaxial
fails 2 '--replay needs a uniaxial one' "$SINEW" test "$SOURCE/tests/cli/biaxial.yaml" --replay one.csv
fails 2 'law exponential is uniaxial' "$SINEW" fit one.csv --elastic exponential
fails 2 'no time column' "$SINEW" fit "$data/protocol-1-1.csv" --elastic fung-planar --memory kelvin
printf 'time [s],stretch [1],stress [kPa]\n0,1,0\n1,1.1,1\n2,1.2,3\n3,1.3,9\n' >strip.csv
fails 2 'is a membrane and the curve' "$SINEW" fit strip.csv --elastic fung-planar
fails 2 'add biaxial curves' "$SINEW" fit strip.csv --elastic fung
printf 'stretch_1 [1],stress_1 [kPa],stretch_2 [1]\n1,0,1\n1.1,1,1\n1.2,3,1\n' >half.csv
fails 2 'the stress of the second axis' "$SINEW" fit half.csv --elastic fung-planar
printf 'stretch_1 [1],stress_1 [kPa],stretch [1]\n1,0,1\n1.1,1,1\n1.2,3,1\n' >two.csv
fails 2 'two kinds of test' "$SINEW" fit two.csv --elastic fung-planar
