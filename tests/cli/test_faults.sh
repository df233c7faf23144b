#!/bin/bash
# Every command where an allocation of its own, a write, or the last step of an output fails: one clear line, exit code
# 1, outputs whole or as before, nothing left. FAULTS=1000000 makes every one fail in turn; usually some of each do.
. "$(dirname "$0")/lib.sh"
if ! full; then
    echo 'SKIPPED: the sanitizers have an allocator of their own'
    exit 0
fi
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
most=${FAULTS:-10}

"$FUZZ_SEEDS" "$root/seeds" || exit 1
cp "$root/seeds/basis/1.gonio" b.gonio
cp "$root/seeds/basis/0.gonio" mixed.gonio
cp "$root/seeds/material/isotropic.bsdf" m.bsdf
cp "$root/seeds/material/matrices.xml" m.xml
cp m.xml n.xml
cp "$root/seeds/readings/zemax" z.bsdf
cp "$root/seeds/mesh/plain.obj" mesh.obj
cat >r.csv <<'END'
# gonio readings
theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R_per_sr,G_per_sr,B_per_sr
30,0,40,180,0.1,0.2,0.3
30,90,50,270,0.4,0.5,0.6
0,0,10,0,1.4,1.5,1.6
END
grep -v '^#' r.csv | cut -d , -f 1-4 >p.csv

# survives OUTPUTS ARGUMENTS...: the command does, whatever fails.
survives() {
    local outputs=$1
    shift
    checks=$((checks + 1))
    "$FAULTS_RUN" "$FAULTS_SHIM" "$most" "$outputs" "$GONIO" "$@" >"$root/work/faults" 2>&1 ||
        failed "gonio $*" "$(head -30 "$root/work/faults")"
}
survives - info -q r.csv --json
survives - info -q b.gonio
survives r.json convert -q r.csv r.json
survives z.csv convert -q z.bsdf z.csv
survives p.out,h.out plan -q b.gonio -n 2 -K 2 --method random --history h.out -o p.out
survives p.out plan -q mixed.gonio -n 2 --candidates p.csv -o p.out
survives m.out measure -q p.csv r.csv -o m.out
survives - check -q two-arms
survives - compare -q r.csv r.csv --json
survives at.out reconstruct -q mixed.gonio r.csv --predict-at p.csv -o at.out
survives n.out next -q mixed.gonio r.csv -n 1 -o n.out
most=$((most / 3)) # they take longer
survives - info -q m.bsdf --json
survives x.csv convert -q m.xml x.csv
survives m.out measure -q p.csv m.bsdf --noise 1 -o m.out
survives t.out,d.out reconstruct -q mixed.gonio r.csv --deviation d.out -o t.out
survives l.out learn -q --grid bivariate m.bsdf n.xml -o l.out
finish
