// An anisotropic material in the plane of incidence, at any azimuth of the sample: what
// src/page/turned_table.c packs. phi_h takes the place of phi_d, which is 0 there.
import { periodic, PHI_D_BINS, radians, type Table } from './brdf';
import type { Triple } from './data';

const AZIMUTHS = PHI_D_BINS;

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
        const phiH = half < 0 ? phiI + 180 : phiI;
        return this.table.between(
            { thetaH: Math.abs(half), thetaD },
            periodic((phiH / 360) * AZIMUTHS, AZIMUTHS),
        );
    }
}
