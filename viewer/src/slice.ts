// Section 3: the image slice, theta_h across and theta_d up, at one phi_d.
import {
    binCentre,
    CHANNEL_NAMES,
    cosines,
    degrees,
    halfDifference,
    ofChannel,
    PHI_D_BINS,
    scaleOf,
    THETA_D_BINS,
    THETA_H_BINS,
    toLog,
    vectorOf,
    type Channel,
    type Table,
} from './brdf';
import {
    bytesOf,
    deviationColours,
    differenceColours,
    themeColour,
    tinted,
    valueColours,
    type ColourMap,
} from './colour';
import { byId, choice, short, slider, toggle } from './controls';
import type { Reading, Triple } from './data';
import { onTheme } from './theme';

type Layer = 'original' | 'reconstruction' | 'error' | 'uncertainty';
type Shown = 'R' | 'G' | 'B' | 'luminance' | 'colour';

const TICKS = [1, 5, 10, 20, 30, 45, 60, 75, 90];
const MARGIN = { left: 58, right: 14, top: 12, bottom: 48 };

interface Scale {
    low: number;
    high: number;
    map: ColourMap;
    /** 0 .. 1 of a cell's number; of the ends' labels. */
    share(value: number): number;
    text(value: number): string;
}

export class SliceSection {
    private readonly canvas = byId<HTMLCanvasElement>('slice-canvas');
    private layer: Layer = 'original';
    private shown: Shown = 'luminance';
    private logarithmic = true;
    private marks = true;
    private phi = 89;
    private cursor: [number, number] | null = null;

    constructor(
        private readonly original: Table,
        private readonly reconstruction: Table | null,
        private readonly deviation: Table | null,
        private readonly readings: Reading[],
    ) {
        this.makeControls();
        this.listen();
        onTheme(() => this.draw());
        new ResizeObserver(() => this.draw()).observe(this.canvas);
        this.tell();
    }

    private makeControls() {
        const parent = byId('slice-controls');
        const layers: [Layer, string][] = [['original', 'original']];
        if (this.reconstruction) {
            layers.push(['reconstruction', 'reconstruction'], ['error', 'error']);
        }
        if (this.deviation) {
            layers.push(['uncertainty', 'uncertainty']);
        }
        const redraw = () => {
            this.draw();
            this.tell();
        };
        if (layers.length > 1) {
            choice(parent, 'layer', 'Layer', layers, this.layer, (value) => {
                this.layer = value;
                redraw();
            });
        }
        const shown: [Shown, string][] = [
            ...CHANNEL_NAMES.map((c): [Shown, string] => [c, c]),
            ['colour', 'colour'],
        ];
        choice(parent, 'slice-channel', 'Channel', shown, this.shown, (value) => {
            this.shown = value;
            redraw();
        });
        const angle = (k: number) => `${degrees(binCentre(0, 0, k).phiD).toFixed(1)}°`;
        slider(parent, 'phi-d', 'φd', [0, PHI_D_BINS - 1, 1], this.phi, angle, (value) => {
            this.phi = value;
            redraw();
        });
        toggle(parent, 'slice-log', 'Logarithmic', true, (value) => {
            this.logarithmic = value;
            redraw();
        });
        if (this.readings.length > 0) {
            toggle(parent, 'slice-marks', 'Mark the readings', true, (value) => {
                this.marks = value;
                redraw();
            });
        }
    }

    // ---- numbers ----

    private get channel(): Channel {
        return this.shown === 'colour' ? 3 : (CHANNEL_NAMES.indexOf(this.shown) as Channel);
    }

    private get table(): Table {
        return this.layer === 'reconstruction' && this.reconstruction
            ? this.reconstruction
            : this.original;
    }

    private deviationAt(h: number, d: number): number | null {
        const value = this.deviation?.atBin(h, d, this.phi);
        return value
            ? this.channel === 3
                ? (value[0] + value[1] + value[2]) / 3
                : value[this.channel]
            : null;
    }

    /** ln(1 + rho'/s) - ln(1 + rho/s). */
    private errorAt(h: number, d: number): number | null {
        const from = this.original.atBin(h, d, this.phi);
        const to = this.reconstruction?.atBin(h, d, this.phi);
        const of = (value: Triple) => toLog(ofChannel(value, this.channel), this.channel);
        return from && to ? of(to) - of(from) : null;
    }

    private numberAt(h: number, d: number): number | null {
        if (this.layer === 'error') {
            return this.errorAt(h, d);
        }
        if (this.layer === 'uncertainty') {
            return this.deviationAt(h, d);
        }
        const value = this.table.atBin(h, d, this.phi);
        return value ? ofChannel(value, this.channel) : null;
    }

    /** The greatest of what a layer shows, over both tables so that they share their scale. */
    private greatest(): number {
        let most = 0;
        const tables = this.reconstruction ? [this.original, this.reconstruction] : [this.original];
        for (let h = 0; h < THETA_H_BINS; h++) {
            for (let d = 0; d < THETA_D_BINS; d++) {
                if (this.layer === 'error' || this.layer === 'uncertainty') {
                    most = Math.max(most, Math.abs(this.numberAt(h, d) ?? 0));
                } else {
                    for (const table of tables) {
                        const value = table.atBin(h, d, this.phi);
                        most = Math.max(most, value ? ofChannel(value, this.channel) : 0);
                    }
                }
            }
        }
        return most > 0 ? most : 1;
    }

    private scale(): Scale {
        const high = this.greatest();
        if (this.layer === 'error') {
            const share = (v: number) => 0.5 + (0.5 * v) / high;
            return { low: -high, high, map: differenceColours, share, text: (v) => signedShort(v) };
        }
        if (this.layer === 'uncertainty') {
            return {
                low: 0,
                high,
                map: deviationColours,
                share: (v) => v / high,
                text: (v) => short(v, 2),
            };
        }
        if (!this.logarithmic) {
            return {
                low: 0,
                high,
                map: valueColours,
                share: (v) => v / high,
                text: (v) => short(v, 2),
            };
        }
        const s = scaleOf(this.channel);
        const top = Math.log1p(high / s);
        return {
            low: 0,
            high,
            map: valueColours,
            share: (v) => Math.log1p(v / s) / top,
            text: (v) => short(v, 2),
        };
    }

    // ---- drawing ----

    private area() {
        const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
        return {
            width: width - MARGIN.left - MARGIN.right,
            height: height - MARGIN.top - MARGIN.bottom,
        };
    }

    private draw() {
        const ratio = Math.min(devicePixelRatio, 2);
        const { canvas } = this;
        canvas.width = Math.round(canvas.clientWidth * ratio);
        canvas.height = Math.round(canvas.clientHeight * ratio);
        const context = canvas.getContext('2d')!;
        context.setTransform(ratio, 0, 0, ratio, 0, 0);
        const scale = this.scale();
        const { width, height } = this.area();
        context.imageSmoothingEnabled = false;
        context.drawImage(this.cells(scale), MARGIN.left, MARGIN.top, width, height);
        this.drawAxes(context);
        if (this.marks) {
            this.drawMarks(context);
        }
        this.drawCursor(context);
        this.drawLegend(scale);
    }

    private cells(scale: Scale): HTMLCanvasElement {
        const small = document.createElement('canvas');
        small.width = THETA_H_BINS;
        small.height = THETA_D_BINS;
        const image = new ImageData(THETA_H_BINS, THETA_D_BINS);
        for (let h = 0; h < THETA_H_BINS; h++) {
            for (let d = 0; d < THETA_D_BINS; d++) {
                const colour = this.colourAt(h, d, scale);
                if (colour) {
                    image.data.set(
                        [...colour, 255],
                        4 * ((THETA_D_BINS - 1 - d) * THETA_H_BINS + h),
                    );
                }
            }
        }
        small.getContext('2d')!.putImageData(image, 0, 0);
        return small;
    }

    private colourAt(h: number, d: number, scale: Scale): Triple | null {
        const number = this.numberAt(h, d);
        if (number === null) {
            return null;
        }
        const share = Math.min(Math.max(scale.share(number), 0), 1);
        if (
            this.shown === 'colour' &&
            (this.layer === 'original' || this.layer === 'reconstruction')
        ) {
            const value = this.table.atBin(h, d, this.phi)!;
            return tinted(value, share).map((c) => 255 * c) as Triple;
        }
        return bytesOf(scale.map(share));
    }

    private x(thetaH: number) {
        return MARGIN.left + Math.sqrt(thetaH / 90) * this.area().width;
    }

    private y(thetaD: number) {
        return MARGIN.top + (1 - thetaD / 90) * this.area().height;
    }

    private drawAxes(context: CanvasRenderingContext2D) {
        const { width, height } = this.area();
        context.strokeStyle = context.fillStyle = themeColour('text');
        context.lineWidth = 1;
        context.strokeRect(MARGIN.left, MARGIN.top, width, height);
        context.font = '12px system-ui, sans-serif';
        context.textAlign = 'center';
        context.textBaseline = 'top';
        for (const tick of TICKS) {
            if (tick !== 75 || width > 320) {
                context.fillRect(this.x(tick) - 0.5, MARGIN.top + height, 1, 5);
                context.fillText(`${tick}°`, this.x(tick), MARGIN.top + height + 8);
            }
        }
        context.fillText(
            'half angle θh (square-root scale, as the grid)',
            MARGIN.left + width / 2,
            MARGIN.top + height + 28,
        );
        context.textAlign = 'right';
        context.textBaseline = 'middle';
        for (let tick = 0; tick <= 90; tick += 15) {
            context.fillRect(MARGIN.left - 5, this.y(tick) - 0.5, 5, 1);
            context.fillText(`${tick}°`, MARGIN.left - 8, this.y(tick));
        }
        context.save();
        context.translate(14, MARGIN.top + height / 2);
        context.rotate(-Math.PI / 2);
        context.textAlign = 'center';
        context.fillText('difference angle θd', 0, 0);
        context.restore();
    }

    /** A ring for each reading, dark and light so that it shows on any colour. */
    private drawMarks(context: CanvasRenderingContext2D) {
        for (const reading of this.readings) {
            const c = halfDifference(vectorOf(reading.incident), vectorOf(reading.outgoing));
            for (const [colour, line] of [
                ['#000', 3.5],
                ['#fff', 1.5],
            ] as const) {
                context.beginPath();
                context.arc(
                    this.x(degrees(c.thetaH)),
                    this.y(degrees(c.thetaD)),
                    4,
                    0,
                    2 * Math.PI,
                );
                context.strokeStyle = colour;
                context.lineWidth = line;
                context.stroke();
            }
        }
    }

    private drawCursor(context: CanvasRenderingContext2D) {
        if (this.cursor) {
            const { width, height } = this.area();
            const [w, h] = [width / THETA_H_BINS, height / THETA_D_BINS];
            const left = MARGIN.left + this.cursor[0] * w;
            const top = MARGIN.top + (THETA_D_BINS - 1 - this.cursor[1]) * h;
            context.lineWidth = 2;
            context.strokeStyle = '#000';
            context.strokeRect(left - 2, top - 2, w + 4, h + 4);
            context.strokeStyle = '#fff';
            context.strokeRect(left - 1, top - 1, w + 2, h + 2);
        }
    }

    private drawLegend(scale: Scale) {
        const colour =
            this.shown === 'colour' &&
            (this.layer === 'original' || this.layer === 'reconstruction');
        const stops = Array.from({ length: 13 }, (_, k) =>
            colour
                ? `rgb(${(255 * k) / 12} ${(255 * k) / 12} ${(255 * k) / 12})`
                : scale.map(k / 12),
        );
        byId('slice-ramp').style.background = `linear-gradient(to right, ${stops.join(', ')})`;
        byId('slice-low').textContent = scale.text(scale.low);
        byId('slice-high').textContent = scale.text(scale.high);
        byId('slice-unit').textContent = {
            original: `BRDF, 1/sr${this.logarithmic ? ', logarithmic: ln(1 + ρ/s)' : ''}`,
            reconstruction: `BRDF, 1/sr${this.logarithmic ? ', logarithmic: ln(1 + ρ/s)' : ''}`,
            error: 'error in g = ln(1 + ρ/s): reconstruction less original',
            uncertainty: 'standard deviation of g = ln(1 + ρ/s)',
        }[this.layer];
    }

    // ---- pointing ----

    private listen() {
        const { canvas } = this;
        canvas.addEventListener('pointermove', (event) => {
            const { width, height } = this.area();
            const h = Math.floor(((event.offsetX - MARGIN.left) / width) * THETA_H_BINS);
            const d =
                THETA_D_BINS -
                1 -
                Math.floor(((event.offsetY - MARGIN.top) / height) * THETA_D_BINS);
            const inside = h >= 0 && h < THETA_H_BINS && d >= 0 && d < THETA_D_BINS;
            this.moveTo(inside ? [h, d] : null);
        });
        canvas.addEventListener('pointerleave', () => this.moveTo(null));
        canvas.addEventListener('keydown', (event) => {
            const step = {
                ArrowLeft: [-1, 0],
                ArrowRight: [1, 0],
                ArrowUp: [0, 1],
                ArrowDown: [0, -1],
            }[event.key];
            if (step) {
                event.preventDefault();
                const [h, d] = this.cursor ?? [10, 10];
                const within = (v: number, count: number) => Math.min(Math.max(v, 0), count - 1);
                const by = event.shiftKey ? 10 : 1;
                this.moveTo([
                    within(h + by * step[0], THETA_H_BINS),
                    within(d + by * step[1], THETA_D_BINS),
                ]);
            }
        });
    }

    private moveTo(cell: [number, number] | null) {
        this.cursor = cell;
        this.draw();
        this.tell();
    }

    private tell() {
        const readout = byId('slice-readout');
        if (!this.cursor) {
            readout.textContent =
                'Point at the picture, or move over it with the arrow keys, to read a bin.';
            return;
        }
        const [h, d] = this.cursor;
        const centre = binCentre(h, d, this.phi);
        const angle = (value: number) => `${degrees(value).toFixed(1)}°`;
        const parts = [
            `θh ${degrees(centre.thetaH).toFixed(2)}°, θd ${angle(centre.thetaD)}, φd ${angle(centre.phiD)}`,
        ];
        const [i, o] = cosines(centre);
        if (i <= 0 || o <= 0) {
            readout.textContent = `${parts[0]} · below the horizon`;
            return;
        }
        const put = (name: string, table: Table | null) => {
            const value = table?.atBin(h, d, this.phi);
            if (table) {
                parts.push(
                    value
                        ? `${name} ${value.map((v) => short(v)).join(', ')} 1/sr`
                        : `${name}: no data`,
                );
            }
        };
        put('original', this.original);
        put('reconstruction', this.reconstruction);
        const error = this.errorAt(h, d);
        const deviation = this.deviationAt(h, d);
        if (error !== null) {
            parts.push(`error of g ${signedShort(error)}`);
        }
        if (deviation !== null) {
            parts.push(`σ of g ${short(deviation, 2)}`);
        }
        readout.textContent = parts.join(' · ');
    }
}

const signedShort = (value: number) => `${value < 0 ? '−' : '+'}${short(Math.abs(value), 2)}`;
