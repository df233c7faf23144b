// Section 4: the BRDF in the plane of incidence as lobes, polar and Cartesian, with its band.
import { CHANNEL_NAMES, LOG_SCALE, ofChannel, radians, type Channel, type Table } from './brdf';
import { Chart, type Series } from './charts';
import { byId, choice, short, slider, toggle } from './controls';
import type { Angles, Triple } from './data';
import type { TurnedTable } from './turned';

/** Angles of view in degrees: positive on the side of the mirror direction. */
const ANGLES = Array.from({ length: 359 }, (_, k) => (k - 179) / 2);
/** 95 % of a normal distribution. */
const WITHIN = 1.96;

type Values = (number | null)[];

interface Lobes {
    original: Values;
    reconstruction: Values | null;
    low: Values | null;
    high: Values | null;
}

const outgoing = (angle: number): Angles => [radians(Math.abs(angle)), angle < 0 ? 0 : Math.PI];

/** Of anisotropic materials, which depend on the azimuth. */
export interface Turned {
    original: TurnedTable | null;
    reconstruction: TurnedTable | null;
}

/** rho at g + factor times its deviation. */
function shifted(rho: Triple, deviation: Triple, factor: number): Triple {
    return rho.map((value, k) => {
        const g = Math.log1p(value / LOG_SCALE[k]) + factor * deviation[k];
        return LOG_SCALE[k] * Math.expm1(Math.max(g, 0));
    }) as Triple;
}

export class LobeSection {
    private incidence = 30;
    private azimuth = 0;
    private channel: Channel = 3;
    private logarithmic = true;
    private readonly chart = new Chart(byId('lobe-chart'), 'Lobes in the plane of incidence', 360);

    constructor(
        private readonly original: Table,
        private readonly reconstruction: Table | null,
        private readonly deviation: Table | null,
        private readonly turned: Turned,
    ) {
        this.makeControls();
        if (!this.deviation || !this.reconstruction) {
            byId('lobe-band').remove();
        }
        if (!this.reconstruction) {
            byId('lobe-key').remove();
        }
        this.draw();
    }

    private makeControls() {
        const parent = byId('lobe-controls');
        const text = (v: number) => `${v}°`;
        slider(parent, 'incidence', 'Incidence θi', [0, 85, 1], this.incidence, text, (value) => {
            this.incidence = value;
            this.draw();
        });
        if (this.turned.original || this.turned.reconstruction) {
            slider(parent, 'azimuth', 'Azimuth φi of the light', [0, 358, 2], 0, text, (value) => {
                this.azimuth = value;
                this.draw();
            });
        }
        const channels = CHANNEL_NAMES.map((c) => [c, c] as const);
        choice(parent, 'lobe-channel', 'Channel', channels, 'luminance', (value) => {
            this.channel = CHANNEL_NAMES.indexOf(value) as Channel;
            this.draw();
        });
        toggle(parent, 'lobe-log', 'Logarithmic', true, (value) => {
            this.logarithmic = value;
            this.draw();
        });
    }

    private lobes(): Lobes {
        const incident: Angles = [radians(this.incidence), 0];
        const values = (table: Table | null, turned?: TurnedTable | null): (Triple | null)[] =>
            ANGLES.map(
                (angle) =>
                    (turned
                        ? turned.at(this.incidence, this.azimuth, angle)
                        : table?.atPair(incident, outgoing(angle))) ?? null,
            );
        const channelOf = (list: (Triple | null)[]): Values =>
            list.map((v) => v && ofChannel(v, this.channel));
        const reconstructed = values(this.reconstruction, this.turned.reconstruction);
        const deviations = values(this.deviation);
        const limit = (factor: number): Values =>
            channelOf(
                reconstructed.map((v, k) => {
                    const deviation = deviations[k];
                    return v && deviation && shifted(v, deviation, factor);
                }),
            );
        const banded = this.reconstruction !== null && this.deviation !== null;
        return {
            original: channelOf(values(this.original, this.turned.original)),
            reconstruction: this.reconstruction ? channelOf(reconstructed) : null,
            low: banded ? limit(-WITHIN) : null,
            high: banded ? limit(WITHIN) : null,
        };
    }

    private draw() {
        const lobes = this.lobes();
        this.drawCartesian(lobes);
        this.drawPolar(lobes);
    }

    private drawCartesian(lobes: Lobes) {
        // A logarithmic axis has no zero.
        const visible = (list: Values): Values =>
            this.logarithmic ? list.map((v) => (v !== null && v > 1e-9 ? v : null)) : list;
        const series: Series[] = [
            { label: 'original', values: visible(lobes.original), colour: 'series-1' },
        ];
        if (lobes.reconstruction) {
            const values = visible(lobes.reconstruction);
            series.push({ label: 'reconstruction', values, colour: 'series-2', dash: [8, 4] });
        }
        let band;
        if (lobes.low && lobes.high) {
            band = { upper: series.length, lower: series.length + 1, colour: 'series-2' };
            const thin = { colour: 'series-2', width: 0.5 };
            series.push({ label: '95 % upper', values: visible(lobes.high), ...thin });
            series.push({ label: '95 % lower', values: visible(lobes.low), ...thin });
        }
        this.chart.show({
            x: {
                label: 'view angle θo, degrees (+ on the mirror’s side)',
                name: 'view angle',
                text: (v) => `${v}°`,
            },
            y: {
                label: `BRDF ${CHANNEL_NAMES[this.channel]}, 1/sr`,
                logarithmic: this.logarithmic,
            },
            at: ANGLES,
            series,
            band,
        });
    }

    // ---- polar ----

    private drawPolar(lobes: Lobes) {
        const svg = byId('lobe-polar');
        const all = [...lobes.original, ...(lobes.reconstruction ?? []), ...(lobes.high ?? [])];
        const greatest = Math.max(...all.map((v) => v ?? 0), 1e-9);
        const top = this.logarithmic ? 10 ** Math.ceil(Math.log10(greatest)) : niceAbove(greatest);
        const decades = decadesBelow(top, lobes.original);
        const radius = (value: number) =>
            this.logarithmic
                ? Math.max(Math.log10(Math.max(value, 1e-12) / top) / decades + 1, 0)
                : value / top;
        const point = (angle: number, r: number) =>
            `${(200 + 180 * r * Math.sin(radians(angle))).toFixed(1)},${(200 - 180 * r * Math.cos(radians(angle))).toFixed(1)}`;
        const path = (values: Values) => {
            const points = values.map((v, k) => (v === null ? null : point(ANGLES[k], radius(v))));
            return points
                .map((p, k) => (p ? `${k > 0 && points[k - 1] ? 'L' : 'M'}${p}` : ''))
                .join('');
        };
        const band = (low: Values, high: Values) => {
            const forth = high.flatMap((v, k) => (v === null ? [] : [point(ANGLES[k], radius(v))]));
            const back = low.flatMap((v, k) => (v === null ? [] : [point(ANGLES[k], radius(v))]));
            return `M${[...forth, ...back.reverse()].join('L')}Z`;
        };
        const parts = [this.polarGrid(top, decades)];
        if (lobes.low && lobes.high) {
            parts.push(`<path class="lobe-area" d="${band(lobes.low, lobes.high)}"/>`);
        }
        parts.push(`<path class="lobe-original" d="${path(lobes.original)}"/>`);
        if (lobes.reconstruction) {
            parts.push(`<path class="lobe-reconstruction" d="${path(lobes.reconstruction)}"/>`);
        }
        const [x, y] = point(-this.incidence, 1.0).split(',');
        parts.push(
            `<line class="ray" x1="${x}" y1="${y}" x2="200" y2="200" marker-end="url(#arrow)"/>`,
            `<line class="mirror" x1="200" y1="200" x2="${point(this.incidence, 1).split(',')[0]}" y2="${y}"/>`,
        );
        svg.innerHTML =
            '<defs><marker id="arrow" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" orient="auto">' +
            '<path class="arrow" d="M0 0L8 4L0 8Z"/></marker></defs>' +
            parts.join('');
    }

    /** Half circles with their values, and spokes with their angles. */
    private polarGrid(top: number, decades: number): string {
        const rings = this.logarithmic
            ? Array.from({ length: decades }, (_, k) => [
                  (k + 1) / decades,
                  top * 10 ** (k + 1 - decades),
              ])
            : [0.25, 0.5, 0.75, 1].map((share) => [share, share * top]);
        const parts = rings.map(([share, value]) => {
            const r = 180 * share;
            const text = `<text x="${200 - r}" y="216" text-anchor="middle">${short(value, 2)}</text>`;
            return `<path class="ring" d="M${200 - r} 200A${r} ${r} 0 0 1 ${200 + r} 200"/>${text}`;
        });
        for (let angle = -90; angle <= 90; angle += 30) {
            const [s, c] = [Math.sin(radians(angle)), Math.cos(radians(angle))];
            parts.push(
                `<line class="ring" x1="200" y1="200" x2="${200 + 180 * s}" y2="${200 - 180 * c}"/>`,
                `<text x="${200 + 191 * s}" y="${204 - 191 * c}" text-anchor="middle">${
                    Math.abs(angle) < 90 ? `${angle}°` : ''
                }</text>`,
            );
        }
        return parts.join('');
    }
}

/** As many decades as it takes to see most of the lobe, one more so that it has a size. */
function decadesBelow(top: number, values: Values): number {
    const sorted = values.filter((v) => v !== null && v > 0).sort((a, b) => a! - b!);
    const low = sorted[Math.floor(sorted.length / 4)] ?? top;
    return Math.min(Math.max(Math.ceil(Math.log10(top / low)) + 1, 2), 7);
}

/** 1, 2 or 5 times a power of ten, at least the value. */
function niceAbove(value: number): number {
    const power = 10 ** Math.floor(Math.log10(value));
    return [1, 2, 5, 10].map((m) => m * power).find((v) => v >= value) ?? value;
}
