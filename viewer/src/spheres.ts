// Section 1: original, reconstruction and their difference as spheres under the same light.
import { degrees, halfDifference, type Table } from './brdf';
import { differenceColours, linearOf, themeColour } from './colour';
import { byId, choice, element, short, signed, slider, button, type Choice } from './controls';
import { SphereRenderer } from './sphere-renderer';
import { DEFAULT_STATE, pairAt, type Lighting, type SphereState } from './sphere-state';
import { onTheme } from './theme';

const SMALLEST = 128; // pixels on a side
const LARGEST = 640;
const SLOW = 100; // milliseconds
const ENOUGH = { lamp: 16, environment: 512, still: 96 }; // samples

const NAMES = ['Original', 'Reconstruction', 'Difference'] as const;

interface Panel {
    mode: 0 | 1 | 2;
    canvas: HTMLCanvasElement;
}

export class SphereSection {
    readonly state: SphereState = { ...DEFAULT_STATE };
    readonly renderer: SphereRenderer;
    private readonly panels: Panel[] = [];
    private readonly controls: Partial<Record<keyof SphereState, Choice<never>>> = {};
    private dragging: 'light' | 'view' = 'light';
    private waiting = false;
    /** Pixels on a side while something moves, fewer on slow machines. */
    private most = LARGEST;
    /** Nothing moves, and there is time for a large picture. */
    private still = false;
    private slowSteps = 0;
    /** Whether somebody can see them: out of view a picture stays as its first samples show it. */
    private inView = false;

    constructor(
        private readonly original: Table,
        private readonly reconstruction: Table | null,
    ) {
        this.renderer = new SphereRenderer(original, reconstruction);
        this.makePanels();
        this.makeControls();
        onTheme(() => this.refresh());
        new ResizeObserver(() => this.fitSize()).observe(this.panels[0].canvas);
        new IntersectionObserver((entries) => {
            this.inView = entries[entries.length - 1].isIntersecting;
            this.next();
        }).observe(byId('sphere-panels'));
        this.renderer.canvas.addEventListener('webglcontextrestored', () => this.restart());
    }

    private makePanels() {
        const parent = byId('sphere-panels');
        for (const mode of this.reconstruction ? ([0, 1, 2] as const) : ([0] as const)) {
            const canvas = element('canvas', {
                tabindex: '0',
                role: 'img',
                'data-sphere': NAMES[mode].toLowerCase(),
                'aria-label': `${NAMES[mode]} as a sphere. Arrow keys move the light, with Shift the view.`,
            });
            this.panels.push({ mode, canvas });
            const figure = element('figure', {}, canvas, element('figcaption', {}, NAMES[mode]));
            if (mode === 2) {
                figure.append(this.makeLegend());
            }
            parent.append(figure);
            this.listen(canvas);
        }
    }

    private makeLegend(): HTMLElement {
        const stops = Array.from({ length: 9 }, (_, k) => differenceColours(k / 8)).join(', ');
        const legend = element('div', { class: 'legend' });
        legend.append(
            element('span', { id: 'range-low' }),
            element('span', {
                class: 'ramp',
                style: `background: linear-gradient(to right, ${stops})`,
            }),
            element('span', { id: 'range-high' }),
        );
        return legend;
    }

    private makeControls() {
        const parent = byId('sphere-controls');
        const { state } = this;
        const number = (
            name: 'lightAzimuth' | 'lightElevation' | 'viewAzimuth' | 'viewElevation' | 'exposure',
            label: string,
            range: [number, number, number],
            text: (value: number) => string,
            redraw: () => void,
        ) => {
            const made = slider(parent, name, label, range, state[name], text, (value) => {
                state[name] = value;
                redraw();
            });
            this.controls[name] = made as unknown as Choice<never>;
        };
        const restart = () => this.restart();
        const refresh = () => this.refresh();
        choice(parent, 'lighting', 'Light', LIGHTING_NAMES, state.lighting, (value) => {
            state.lighting = value;
            byId('sphere-note').textContent = LIGHTING_NOTES[value];
            this.restart();
        });
        byId('sphere-note').textContent = LIGHTING_NOTES[state.lighting];
        choice(
            parent,
            'dragging',
            'Dragging moves the',
            [
                ['light', 'light'],
                ['view', 'view'],
            ],
            'light',
            (value) => (this.dragging = value),
        );
        const angle = (value: number) => `${Math.round(value)}°`;
        number('lightAzimuth', 'Light azimuth', [-180, 180, 1], angle, restart);
        number('lightElevation', 'Light elevation', [-90, 90, 1], angle, restart);
        number('viewAzimuth', 'View azimuth', [-180, 180, 1], angle, restart);
        number('viewElevation', 'View elevation', [-90, 90, 1], angle, restart);
        number('exposure', 'Exposure', [-5, 5, 0.1], (v) => `${signed(v, 1)} stops`, refresh);
        choice(
            parent,
            'tone',
            'Tone mapping',
            [
                ['photographic', 'photographic'],
                ['linear', 'none'],
            ],
            state.tone,
            (value) => {
                state.tone = value;
                this.refresh();
            },
        );
        if (this.reconstruction) {
            slider(
                parent,
                'range',
                'Range of the difference',
                [-3, 2, 1],
                0,
                (v) => `±${2 ** v} stops`,
                (v) => {
                    state.range = 2 ** v;
                    this.showRange();
                    this.refresh();
                },
            );
            this.showRange();
        }
        button(parent, 'reset', 'Reset light and view', () => this.reset());
    }

    private showRange() {
        byId('range-low').textContent = `−${this.state.range} stops (darker)`;
        byId('range-high').textContent = `+${this.state.range} (brighter)`;
    }

    private reset() {
        for (const name of [
            'lightAzimuth',
            'lightElevation',
            'viewAzimuth',
            'viewElevation',
            'exposure',
        ] as const) {
            this.state[name] = DEFAULT_STATE[name];
            this.controls[name]?.set(DEFAULT_STATE[name] as never);
        }
        this.restart();
    }

    /** Moves the light or the view by degrees. */
    private move(what: 'light' | 'view', right: number, up: number) {
        const [azimuth, elevation] = [`${what}Azimuth`, `${what}Elevation`] as [
            'lightAzimuth' | 'viewAzimuth',
            'lightElevation' | 'viewElevation',
        ];
        const { state } = this;
        state[azimuth] = ((((state[azimuth] + right + 180) % 360) + 360) % 360) - 180;
        state[elevation] = Math.min(Math.max(state[elevation] + up, -90), 90);
        this.controls[azimuth]?.set(state[azimuth] as never);
        this.controls[elevation]?.set(state[elevation] as never);
        this.restart();
    }

    private listen(canvas: HTMLCanvasElement) {
        let last: [number, number] | null = null;
        canvas.addEventListener('pointerdown', (event) => {
            canvas.setPointerCapture(event.pointerId);
            last = [event.clientX, event.clientY];
        });
        canvas.addEventListener('pointermove', (event) => {
            if (last) {
                const scale = 180 / canvas.clientWidth;
                const [dx, dy] = [
                    (event.clientX - last[0]) * scale,
                    (last[1] - event.clientY) * scale,
                ];
                const view = this.dragging === 'view' || event.shiftKey;
                // The sphere turns with the hand: the view goes the other way.
                this.move(view ? 'view' : 'light', view ? -dx : dx, view ? -dy : dy);
                last = [event.clientX, event.clientY];
            }
            this.tell(canvas, event);
        });
        const end = () => (last = null);
        canvas.addEventListener('pointerup', end);
        canvas.addEventListener('pointercancel', end);
        canvas.addEventListener(
            'pointerleave',
            () => (byId('sphere-readout').textContent = READOUT_HINT),
        );
        canvas.addEventListener('keydown', (event) => {
            const step = KEYS[event.key];
            if (step) {
                event.preventDefault();
                this.move(event.shiftKey ? 'view' : 'light', step[0] * 5, step[1] * 5);
            }
        });
    }

    /** Angles and values under the pointer. */
    private tell(canvas: HTMLCanvasElement, event: PointerEvent) {
        const pair = pairAt(
            this.state,
            (event.offsetX / canvas.clientWidth) * 2 - 1,
            1 - (event.offsetY / canvas.clientHeight) * 2,
        );
        const readout = byId('sphere-readout');
        if (!pair) {
            readout.textContent = READOUT_HINT;
            return;
        }
        const at = halfDifference(pair.incident, pair.outgoing);
        const angle = (value: number) => `${degrees(value).toFixed(1)}°`;
        const parts = [
            `θi ${angle(Math.acos(pair.incident[2]))}, θo ${angle(Math.acos(pair.outgoing[2]))}`,
            `θh ${angle(at.thetaH)}, θd ${angle(at.thetaD)}`,
        ];
        for (const [name, table] of [
            ['original', this.original],
            ['reconstruction', this.reconstruction],
        ] as const) {
            const value = table?.at(at);
            if (value) {
                parts.push(`${name} ${value.map((v) => short(v)).join(', ')} 1/sr`);
            }
        }
        readout.textContent = parts.join(' · ');
    }

    private fitSize() {
        const wide = this.panels[0].canvas.clientWidth * Math.min(devicePixelRatio, 2);
        const most = this.still ? LARGEST : this.most;
        const size = Math.min(Math.max(Math.round(wide / 32) * 32, SMALLEST), most);
        for (const { canvas } of this.panels) {
            canvas.width = canvas.height = size;
        }
        this.renderer.resize(size);
        this.next();
    }

    /** The light or the view has changed. */
    restart() {
        document.documentElement.dataset.spheres = 'working';
        if (this.still) {
            this.still = false;
            this.fitSize();
        }
        this.renderer.restart();
        this.next();
    }

    /** Only how it is shown has changed. */
    refresh() {
        if (this.renderer.samplesDone === 0) {
            this.restart();
        } else {
            this.present();
        }
    }

    private next() {
        if (!this.waiting && (this.inView || this.renderer.samplesDone === 0)) {
            this.waiting = true;
            requestAnimationFrame(() => {
                this.waiting = false;
                this.step();
            });
        }
    }

    private step() {
        const lamp = this.state.lighting === 'lamp';
        const enough = lamp ? ENOUGH.lamp : this.still ? ENOUGH.still : ENOUGH.environment;
        if (this.renderer.samplesDone < enough) {
            const start = performance.now();
            this.renderer.add(this.state, lamp ? 1 : 4);
            this.present(); // which waits for the GPU
            this.watch(performance.now() - start);
            this.next();
        } else if (!this.still && this.most < LARGEST) {
            this.still = true;
            this.fitSize();
        } else {
            document.documentElement.dataset.spheres = 'finished';
        }
    }

    /** Where steps take long, as without a GPU, pictures are smaller until nothing moves. */
    private watch(milliseconds: number) {
        this.slowSteps = milliseconds > SLOW && !this.still ? this.slowSteps + 1 : 0;
        if (this.slowSteps >= 3 && this.most > SMALLEST) {
            this.slowSteps = 0;
            this.most = Math.max(SMALLEST, Math.min(this.most, this.panels[0].canvas.width) / 2);
            this.fitSize();
        }
    }

    private present() {
        const tone = this.renderer.measure();
        const backdrop = linearOf(themeColour('sphere-backdrop'));
        for (const { mode, canvas } of this.panels) {
            this.renderer.show(this.state, mode, tone, backdrop);
            canvas
                .getContext('2d')
                ?.drawImage(this.renderer.canvas, 0, 0, canvas.width, canvas.height);
        }
    }
}

const LIGHTING_NAMES = [
    ['lamp', 'lamp'],
    ['studio', 'studio'],
    ['sky', 'sky'],
    ['furnace', 'furnace'],
] as const;

const LIGHTING_NOTES: Record<Lighting, string> = {
    lamp: 'A distant lamp: facing it, the surface gets an irradiance of π, so that a white Lambertian has radiance 1.',
    studio: 'A dim room with two soft lamps and a strip from behind, as in gonio render. The light’s azimuth turns it.',
    sky: 'A clear sky with the sun, as in gonio render. The light’s azimuth turns it.',
    furnace: 'White from everywhere: what shows is the share of light that the surface reflects.',
};

const READOUT_HINT = 'Point at a sphere lit by the lamp to read its angles and values.';

const KEYS: Record<string, [number, number]> = {
    ArrowLeft: [-1, 0],
    ArrowRight: [1, 0],
    ArrowUp: [0, 1],
    ArrowDown: [0, -1],
};
