// Charts by uPlot, in the colours of the theme, with numbers as a table for those who cannot see them.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { themeColour } from './colour';
import { element, short } from './controls';
import { onTheme } from './theme';

export interface Axis {
    label: string;
    /** In the legend, if shorter. */
    name?: string;
    logarithmic?: boolean;
    range?: [number, number];
    /** Of the values in the legend and the table. */
    text?: (value: number) => string;
    /** Of the tics, if they are names. */
    names?: string[];
}

export interface Series {
    label: string;
    values: (number | null)[];
    /** Name of a CSS variable: series-1 ... */
    colour: string;
    dash?: number[];
    width?: number;
    points?: boolean;
    /** In legend and table only. */
    hidden?: boolean;
    /** Points without a line. */
    scattered?: boolean;
    /** Not in the legend, and no number of its own: one of many. */
    faint?: boolean;
}

export interface ChartContent {
    x: Axis;
    y: Axis;
    at: number[];
    series: Series[];
    /** Between the series with these numbers. */
    band?: { upper: number; lower: number; colour: string };
    /** Bars between the series with these numbers, which are not drawn themselves. */
    whiskers?: { upper: number; lower: number; colour: string };
}

const faded = (colour: string, alpha: number) =>
    `color-mix(in srgb, ${colour} ${alpha * 100}%, transparent)`;

/** A CSS colour as the canvas takes it. */
function solid(colour: string): string {
    const probe = element('span', { style: `color: ${colour}; display: none` });
    document.body.append(probe);
    const value = getComputedStyle(probe).color;
    probe.remove();
    return value;
}

const isPowerOfTen = (value: number) =>
    Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9;

export class Chart {
    private plot: uPlot | null = null;
    private content: ChartContent | null = null;
    private readonly box: HTMLElement;
    private readonly numbers: HTMLDetailsElement;

    constructor(
        parent: HTMLElement,
        private readonly name: string,
        private readonly height = 320,
    ) {
        this.box = element('div', {
            class: 'chart',
            tabindex: '0',
            role: 'img',
            'data-chart': name,
            'aria-label': `${name}. Arrow keys move the cursor; the numbers are in a table below.`,
        });
        this.numbers = element('details', { class: 'numbers' }, element('summary', {}, 'Numbers'));
        this.numbers.addEventListener('toggle', () => this.fillNumbers());
        parent.append(this.box, this.numbers);
        this.box.addEventListener('keydown', (event) => this.onKey(event));
        onTheme(() => this.rebuild());
        new ResizeObserver(() => this.fitSize()).observe(this.box);
    }

    /** Shows other content; the same series with other values are replaced in place. */
    show(content: ChartContent) {
        const before = this.content;
        this.content = content;
        const alike =
            this.plot !== null &&
            before !== null &&
            before.y.label === content.y.label &&
            before.y.logarithmic === content.y.logarithmic &&
            before.series.map((s) => s.label).join() === content.series.map((s) => s.label).join();
        if (alike) {
            this.plot?.setData(this.data());
        } else {
            this.rebuild();
        }
        this.fillNumbers();
    }

    private data(): uPlot.AlignedData {
        return [
            this.content!.at,
            ...this.content!.series.map((s) => s.values),
        ] as uPlot.AlignedData;
    }

    private fitSize() {
        const width = this.box.clientWidth;
        if (this.content && width > 0 && this.plot?.width !== width) {
            if (this.plot) {
                this.plot.setSize({ width, height: this.height });
            } else {
                this.rebuild();
            }
        }
    }

    private rebuild() {
        this.plot?.destroy();
        this.plot = null;
        const width = this.box.clientWidth;
        if (this.content && width > 0) {
            this.plot = new uPlot(this.options(this.content, width), this.data(), this.box);
            this.openLegend();
        }
    }

    private options(content: ChartContent, width: number): uPlot.Options {
        return {
            width,
            height: this.height,
            scales: { x: this.scaleOf(content.x), y: this.scaleOf(content.y) },
            axes: [this.axisOf(content.x), { ...this.axisOf(content.y), size: 64 }],
            series: [
                {
                    label: content.x.name ?? content.x.label,
                    value: (_, v) => (v === null ? '–' : this.textOfX(v)),
                },
                ...content.series.map((s) => this.seriesOf(s, content.y)),
            ],
            bands: content.band
                ? [
                      {
                          series: [content.band.upper + 1, content.band.lower + 1],
                          fill: solid(faded(themeColour(content.band.colour), 0.25)),
                      },
                  ]
                : [],
            cursor: { focus: { prox: 24 }, drag: { x: true, y: false } },
            focus: { alpha: 0.35 },
            legend: { live: true },
            hooks: { draw: [(plot) => this.drawWhiskers(plot)] },
        };
    }

    private drawWhiskers(plot: uPlot) {
        const { at, series, whiskers } = this.content!;
        if (!whiskers) {
            return;
        }
        const { ctx } = plot;
        ctx.strokeStyle = themeColour(whiskers.colour);
        ctx.lineWidth = 2 * devicePixelRatio;
        at.forEach((value, k) => {
            const x = plot.valToPos(value, 'x', true);
            const ends = [whiskers.lower, whiskers.upper].map((which) => series[which].values[k]);
            if (ends[0] !== null && ends[1] !== null) {
                ctx.beginPath();
                ctx.moveTo(x, plot.valToPos(ends[0], 'y', true));
                ctx.lineTo(x, plot.valToPos(ends[1], 'y', true));
                ctx.stroke();
            }
        });
    }

    private textOfX(value: number): string {
        const { x } = this.content!;
        return x.names ? (x.names[value] ?? '') : (x.text ?? short)(value);
    }

    private scaleOf(axis: Axis): uPlot.Scale {
        const scale: uPlot.Scale = { time: false, distr: axis.logarithmic ? 3 : 1 };
        const { names, range } = axis;
        if (range) {
            scale.range = () => range;
        } else if (names) {
            // Room at both ends, unless a part is enlarged.
            const last = names.length - 1;
            scale.range = (_, from, to) =>
                from <= 0 && to >= last ? [-0.5, last + 0.5] : [from, to];
        }
        return scale;
    }

    private axisOf(axis: Axis): uPlot.Axis {
        const line = { stroke: themeColour('grid'), width: 1 };
        const made: uPlot.Axis = {
            label: axis.label,
            stroke: themeColour('text'),
            font: '12px system-ui, sans-serif',
            labelFont: '12px system-ui, sans-serif',
            grid: line,
            ticks: line,
        };
        if (axis.names) {
            made.values = (_, ticks) =>
                ticks.map((t) => (Number.isInteger(t) ? (axis.names![t] ?? '') : ''));
        } else if (axis.logarithmic) {
            made.values = (_, ticks) => ticks.map((t) => (isPowerOfTen(t) ? short(t) : ''));
        }
        return made;
    }

    private seriesOf(s: Series, y: Axis): uPlot.Series {
        const colour = s.colour.startsWith('#') ? s.colour : themeColour(s.colour);
        return {
            label: s.label,
            stroke: s.faint ? solid(faded(colour, 0.5)) : colour,
            width: s.scattered || s.hidden ? 0 : (s.width ?? 2),
            dash: s.dash,
            points: {
                show: s.hidden ? false : s.points || s.scattered ? true : undefined,
                size: 6,
                fill: colour,
                stroke: colour,
            },
            paths: s.scattered || s.hidden ? () => null : undefined,
            value: (_, v) => (v === null || v === undefined ? '–' : (y.text ?? short)(v)),
            class: s.faint ? 'faint' : undefined,
            spanGaps: true,
        };
    }

    /** uPlot's legend toggles series by a click; by keyboard too. */
    private openLegend() {
        for (const entry of this.box.querySelectorAll<HTMLElement>(
            '.u-legend .u-series:not(:first-child) th',
        )) {
            entry.tabIndex = 0;
            entry.setAttribute('role', 'button');
            entry.addEventListener('keydown', (event) => {
                if (event.key === 'Enter' || event.key === ' ') {
                    event.preventDefault();
                    event.stopPropagation();
                    entry.click();
                }
            });
        }
    }

    private onKey(event: KeyboardEvent) {
        const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        if (step === undefined || !this.plot || event.target !== this.box) {
            return;
        }
        event.preventDefault();
        const { at } = this.content!;
        const next = Math.min(
            Math.max((this.plot.cursor.idx ?? (step > 0 ? -1 : at.length)) + step, 0),
            at.length - 1,
        );
        this.plot.setCursor({ left: this.plot.valToPos(at[next], 'x'), top: this.height / 3 });
    }

    private fillNumbers() {
        this.numbers.querySelector('.scroll')?.remove();
        if (!this.numbers.open || !this.content) {
            return;
        }
        const { at, series, x, y } = this.content;
        const told = series.filter((s) => !s.faint);
        const head = element(
            'tr',
            {},
            ...[x.label, ...told.map((s) => s.label)].map((t) => element('th', {}, t)),
        );
        const table = element('table', { class: 'small' }, head);
        at.forEach((value, k) => {
            const cells = told.map((s) => {
                const v = s.values[k];
                return element('td', {}, v === null || v === undefined ? '' : (y.text ?? short)(v));
            });
            table.append(
                element('tr', {}, element('th', { scope: 'row' }, this.textOfX(value)), ...cells),
            );
        });
        this.numbers.append(
            element('div', { class: 'scroll', tabindex: '0', 'aria-label': this.name }, table),
        );
    }
}
