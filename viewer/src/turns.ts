// How the sample is turned in a plan: the azimuths of the light on it, and the readings of each.
import { degrees } from './brdf';
import { byId, slider, type Choice } from './controls';
import type { Reading } from './data';

/** Readings at one azimuth or, if there are many, in one sector: degrees. */
export interface Turn {
    low: number;
    high: number;
    readings: number[];
}

/** More azimuths than these are shown in sectors. */
const MOST = 36;
const SECTOR = 15;
/** Azimuths that agree to this are one, degrees. */
const SAME = 0.1;

/** The azimuth of the light; at normal incidence, which has none, that of the view. */
function azimuthOf(reading: Reading): number {
    const [theta, phi] = reading.incident;
    const azimuth = degrees(theta < 1e-6 ? reading.outgoing[1] : phi);
    return ((azimuth % 360) + 360) % 360;
}

function group(readings: Reading[], width: number): Turn[] {
    const groups = new Map<number, Turn>();
    readings.forEach((reading, k) => {
        const exact = width === SAME;
        const place = azimuthOf(reading) / width;
        const index = (exact ? Math.round(place) : Math.floor(place)) % Math.round(360 / width);
        const low = index * width;
        const turn = groups.get(index) ?? { low, high: exact ? low : low + width, readings: [] };
        turn.readings.push(k);
        groups.set(index, turn);
    });
    return [...groups.values()].sort((a, b) => a.low - b.low);
}

export function turnsOf(readings: Reading[]): Turn[] {
    const exact = group(readings, SAME);
    return exact.length <= MOST ? exact : group(readings, SECTOR);
}

const angle = (value: number) => `${Number(value.toFixed(1))}°`;
const nameOf = ({ low, high }: Turn) =>
    low === high ? angle(low) : `${angle(low)} to ${angle(high)}`;
const count = (n: number) => `${n} ${n === 1 ? 'reading' : 'readings'}`;

const INNER = 40;
const OUTER = 66;

/** A piece of a ring, azimuth 0 to the right and counted to the left, as the hemisphere's. */
function piece(low: number, high: number, inner: number, outer: number): string {
    const at = (azimuth: number, r: number) => {
        const a = (azimuth * Math.PI) / 180;
        return `${(r * Math.cos(a)).toFixed(2)} ${(-r * Math.sin(a)).toFixed(2)}`;
    };
    const arc = (r: number, sweep: number, to: string) => `A${r} ${r} 0 0 ${sweep} ${to}`;
    return (
        `M${at(low, inner)}L${at(low, outer)}${arc(outer, 0, at(high, outer))}` +
        `L${at(high, inner)}${arc(inner, 1, at(low, inner))}Z`
    );
}

/** A dial of the sample's azimuths and a slider that goes through them. */
export class TurnDial {
    private turns: Turn[] = [];
    private choice: Choice<number> | null = null;
    private chosen = 0; // 0: all

    /** changed: with the readings of the chosen azimuth, null for all. */
    constructor(private readonly changed: (readings: Set<number> | null) => void) {
        byId('turn-part').hidden = false;
        byId('turn-dial').addEventListener('click', (event) => {
            const at = (event.target as Element).getAttribute('data-turn');
            if (at !== null) {
                const next = Number(at) === this.chosen ? 0 : Number(at);
                this.choice?.set(next);
                this.choose(next);
            }
        });
    }

    show(readings: Reading[]) {
        this.turns = turnsOf(readings);
        const parent = byId('turn-controls');
        parent.replaceChildren();
        this.choice = slider(
            parent,
            'turn',
            'Azimuth of the light on the sample',
            [0, this.turns.length, 1],
            0,
            (value) => (value === 0 ? 'all' : nameOf(this.turns[value - 1])),
            (value) => this.choose(value),
        );
        this.chosen = 0;
        this.draw();
    }

    private choose(which: number) {
        this.chosen = which;
        this.draw();
        const turn = this.turns[which - 1];
        this.changed(turn ? new Set(turn.readings) : null);
    }

    private draw() {
        const most = Math.max(...this.turns.map((turn) => turn.readings.length));
        const bars = this.turns.map((turn, k) => {
            const narrow = turn.low === turn.high;
            const [low, high] = narrow
                ? [turn.low - 2, turn.high + 2]
                : [turn.low + 1, turn.high - 1];
            const outer = INNER + ((OUTER - INNER) * turn.readings.length) / most;
            const name = `${nameOf(turn)}: ${count(turn.readings.length)}`;
            const kind = k + 1 === this.chosen ? 'turn chosen' : 'turn';
            return `<path class="${kind}" data-turn="${k + 1}" d="${piece(low, high, INNER, outer)}"><title>${name}</title></path>`;
        });
        const labels = [0, 90, 180, 270].map((azimuth) => {
            const a = (azimuth * Math.PI) / 180;
            const [x, y] = [27 * Math.cos(a), -27 * Math.sin(a) + 4];
            return `<text x="${x.toFixed(1)}" y="${y.toFixed(1)}" text-anchor="middle">${azimuth}°</text>`;
        });
        byId('turn-dial').innerHTML =
            `<circle class="ring" r="${INNER}"/>` + bars.join('') + labels.join('');
        byId('turn-readout').textContent = this.told();
    }

    /** What the dial shows, in words. */
    private told(): string {
        const turn = this.turns[this.chosen - 1];
        if (turn) {
            const numbers = turn.readings.map((k) => k + 1).join(', ');
            return `${count(turn.readings.length)} at ${nameOf(turn)}: ${numbers}`;
        }
        const sectors = this.turns.some((t) => t.low !== t.high);
        return sectors
            ? `Azimuths in sectors of ${SECTOR}°: the more readings, the longer the bar.`
            : `${this.turns.length} azimuths: the more readings, the longer the bar.`;
    }
}
