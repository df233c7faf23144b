// An anisotropic material in the plane of incidence, at any azimuth of the sample: what
// src/page/turned_table.c packs. phi_h takes the place of phi_d, which is 0 there.
import {
    clamped,
    periodic,
    PHI_D_BINS,
    radians,
    THETA_D_BINS,
    THETA_H_BINS,
    type Table,
} from './brdf';
import type { Triple } from './data';

const AZIMUTHS = PHI_D_BINS;

/** Neighbours along one axis: both bins and the weight of the upper one. */
type Neighbours = readonly [number, number, number];

const positionOf = (angle: number, bins: number) => (angle / (Math.PI / 2)) * bins;

export class TurnedTable {
    constructor(private readonly table: Table) {}

    /**
     * Light at theta_i and azimuth phi_i, view in its plane, positive on the side of the mirror
     * direction; degrees. Null without data and below the horizon.
     */
    at(thetaI: number, phiI: number, view: number): Triple | null {
        if (Math.abs(thetaI) >= 90 || Math.abs(view) >= 90) {
            return null;
        }
        const half = radians((thetaI - view) / 2); // towards the light
        const thetaD = radians(Math.abs(thetaI + view) / 2);
        const phiH = radians(half < 0 ? phiI + 180 : phiI);
        const rooted = Math.sqrt(Math.abs(half) / (Math.PI / 2)) * THETA_H_BINS;
        return this.between(
            clamped(rooted, THETA_H_BINS),
            clamped(positionOf(thetaD, THETA_D_BINS), THETA_D_BINS),
            periodic((phiH / (2 * Math.PI)) * AZIMUTHS, AZIMUTHS),
        );
    }

    /** Bins without data are left out, the others count for more. */
    private between(h: Neighbours, d: Neighbours, phi: Neighbours): Triple | null {
        const sum = [0, 0, 0];
        let weights = 0;
        for (let k = 0; k < 8; k++) {
            const [a, b, c] = [(k >> 2) & 1, (k >> 1) & 1, k & 1];
            const share = (n: Neighbours, upper: number) => (upper ? n[2] : 1 - n[2]);
            const weight = share(h, a) * share(d, b) * share(phi, c);
            const value = this.table.atBin(h[a], d[b], phi[c]);
            if (value && weight > 0) {
                value.forEach((v, channel) => (sum[channel] += weight * v));
                weights += weight;
            }
        }
        return weights > 0 ? [sum[0] / weights, sum[1] / weights, sum[2] / weights] : null;
    }
}
