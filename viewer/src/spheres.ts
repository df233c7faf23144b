// Section 1: original, reconstruction and their difference as spheres under the same light.
import {
    DataTexture,
    Data3DTexture,
    ClampToEdgeWrapping,
    FloatType,
    GLSL3,
    HalfFloatType,
    LinearFilter,
    Matrix3,
    Mesh,
    NearestFilter,
    OrthographicCamera,
    PlaneGeometry,
    RawShaderMaterial,
    RepeatWrapping,
    RGBAFormat,
    Vector2,
    Vector3,
    WebGLRenderer,
    WebGLRenderTarget,
    type IUniform,
} from 'three';
import {
    degrees,
    halfDifference,
    luminance,
    PHI_D_BINS,
    radians,
    THETA_D_BINS,
    THETA_H_BINS,
    type Table,
} from './brdf';
import { differenceColours, linearOf, ramp, themeColour } from './colour';
import { byId, choice, element, short, signed, slider, button, type Choice } from './controls';
import type { Triple } from './data';
import * as shaders from './shaders';
import { onTheme } from './theme';

export type Lighting = 'lamp' | 'studio' | 'sky' | 'furnace';
const LIGHTINGS: Lighting[] = ['lamp', 'studio', 'sky', 'furnace'];

/** All that the pictures depend on; angles in degrees. */
export interface SphereState {
    lighting: Lighting;
    /** Of the lamp, seen from the sphere: to the right of +z, and above it; turns environments. */
    lightAzimuth: number;
    lightElevation: number;
    viewAzimuth: number;
    viewElevation: number;
    /** Stops. */
    exposure: number;
    tone: 'photographic' | 'linear';
    /** Stops at the ends of the difference's colours. */
    range: number;
}

const FIELD_OF_VIEW = radians(30);
const KEY = 0.18;
const BLOCKS = 32;
const SMALLEST = 128; // pixels on a side
const LARGEST = 640;
const SLOW = 100; // milliseconds
const ENOUGH = { lamp: 16, environment: 512, still: 96 }; // samples

export function directionOf(azimuth: number, elevation: number): Triple {
    const [a, e] = [radians(azimuth), radians(elevation)];
    return [Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)];
}

const cross = (a: Triple, b: Triple): Triple => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
];

/** Right, up, towards the viewer. */
function cameraOf(state: SphereState): [Triple, Triple, Triple] {
    const back = directionOf(state.viewAzimuth, state.viewElevation);
    const a = radians(state.viewAzimuth);
    const right: Triple = [Math.cos(a), 0, -Math.sin(a)];
    return [right, cross(back, right), back];
}

function textureOf(table: Table): Data3DTexture {
    const texture = new Data3DTexture(table.halves, PHI_D_BINS, THETA_D_BINS, THETA_H_BINS);
    texture.format = RGBAFormat;
    texture.type = HalfFloatType;
    texture.minFilter = texture.magFilter = LinearFilter;
    texture.wrapS = RepeatWrapping; // phi_d: reciprocity
    texture.wrapT = texture.wrapR = ClampToEdgeWrapping;
    texture.unpackAlignment = 4;
    texture.needsUpdate = true;
    return texture;
}

/** Distribution function of theta_h bins by the mean luminance there, and the density of h. */
function highlightOf(table: Table): DataTexture {
    const weight = new Float64Array(THETA_H_BINS);
    const solid = new Float64Array(THETA_H_BINS);
    for (let h = 0; h < THETA_H_BINS; h++) {
        let [sum, count] = [0, 0];
        for (let d = 0; d < 60; d += 3) {
            for (let p = 0; p < PHI_D_BINS; p += 30) {
                const value = table.atBin(h, d, p);
                if (value) {
                    sum += luminance(value);
                    count++;
                }
            }
        }
        const edge = (k: number) => Math.cos((k / THETA_H_BINS) ** 2 * (Math.PI / 2));
        solid[h] = 2 * Math.PI * (edge(h) - edge(h + 1));
        weight[h] = (count > 0 ? sum / count + 1e-6 : 1e-6) * solid[h];
    }
    const total = weight.reduce((a, b) => a + b, 0);
    const data = new Float32Array(4 * THETA_H_BINS);
    let below = 0;
    for (let h = 0; h < THETA_H_BINS; h++) {
        below += weight[h] / total;
        data[4 * h] = below;
        data[4 * h + 1] = weight[h] / total / solid[h];
    }
    const texture = new DataTexture(data, THETA_H_BINS, 1, RGBAFormat, FloatType);
    texture.minFilter = texture.magFilter = NearestFilter;
    texture.needsUpdate = true;
    return texture;
}

/** Draws the spheres into textures and reads or shows them. Knows nothing of the page. */
export class SphereRenderer {
    private readonly renderer: WebGLRenderer;
    private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
    private readonly quad: Mesh<PlaneGeometry, RawShaderMaterial>;
    private readonly adding: RawShaderMaterial;
    private readonly measuring: RawShaderMaterial;
    private readonly showing: RawShaderMaterial;
    private readonly blocks: WebGLRenderTarget;
    private targets: [WebGLRenderTarget, WebGLRenderTarget];
    private done = 0;

    constructor(
        original: Table,
        readonly reconstruction: Table | null,
        private size = 256,
    ) {
        this.renderer = new WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
        this.renderer.setPixelRatio(1);
        this.renderer.autoClear = false;
        this.renderer.debug.checkShaderErrors = true;
        const table = textureOf(original);
        this.adding = this.material(shaders.accumulate, {
            original: table,
            reconstruction: reconstruction ? textureOf(reconstruction) : table,
            paired: reconstruction !== null,
            highlight: highlightOf(original),
            previousA: null,
            previousB: null,
            frame: 0,
            samples: 1,
            distanceOfViewer: 1 / Math.sin(Math.atan(0.95 * Math.tan(FIELD_OF_VIEW / 2))),
            lamp: new Vector3(),
        });
        this.measuring = this.material(shaders.measure, { image: null, block: 1 });
        const colours = new DataTexture(ramp(differenceColours, 256), 256, 1, RGBAFormat);
        colours.minFilter = colours.magFilter = LinearFilter;
        colours.needsUpdate = true;
        this.showing = this.material(shaders.show, {
            imageA: null,
            imageB: null,
            colours,
            mode: 0,
            photographic: true,
            scale: 1,
            white: 1,
            range: 1,
            backdrop: new Vector3(),
        });
        this.quad = new Mesh(new PlaneGeometry(2, 2), this.adding);
        this.quad.frustumCulled = false;
        this.blocks = this.target(BLOCKS, 1);
        this.targets = [this.target(size, 2), this.target(size, 2)];
        this.resize(size);
    }

    private material(fragmentShader: string, values: Record<string, unknown>): RawShaderMaterial {
        const shared = {
            lighting: 0,
            turn: 0,
            size: new Vector2(),
            camera: new Matrix3(),
            tangent: Math.tan(FIELD_OF_VIEW / 2),
        };
        const uniforms: Record<string, IUniform> = {};
        for (const [name, value] of Object.entries({ ...shared, ...values })) {
            uniforms[name] = { value };
        }
        return new RawShaderMaterial({
            glslVersion: GLSL3,
            vertexShader: shaders.vertex,
            fragmentShader,
            uniforms,
            depthTest: false,
            depthWrite: false,
        });
    }

    private target(size: number, count: number): WebGLRenderTarget {
        const floats = this.renderer.extensions.has('EXT_color_buffer_float');
        return new WebGLRenderTarget(size, size, {
            count,
            format: RGBAFormat,
            type: floats ? FloatType : HalfFloatType,
            minFilter: NearestFilter,
            magFilter: NearestFilter,
            depthBuffer: false,
        });
    }

    get samplesDone() {
        return this.done;
    }

    get canvas() {
        return this.renderer.domElement;
    }

    resize(size: number) {
        this.size = size;
        this.renderer.setSize(size, size, false);
        this.targets.forEach((target) => target.setSize(size, size));
        this.restart();
    }

    restart() {
        this.done = 0;
    }

    private set(material: RawShaderMaterial, state: SphereState) {
        const u = material.uniforms;
        const [right, up, back] = cameraOf(state);
        u.lighting.value = LIGHTINGS.indexOf(state.lighting);
        u.turn.value = radians(state.lightAzimuth - DEFAULT_STATE.lightAzimuth);
        u.size.value.set(this.size, this.size);
        u.camera.value.set(
            right[0],
            up[0],
            back[0],
            right[1],
            up[1],
            back[1],
            right[2],
            up[2],
            back[2],
        );
    }

    private draw(material: RawShaderMaterial, target: WebGLRenderTarget | null) {
        this.quad.material = material;
        this.renderer.setRenderTarget(target);
        this.renderer.render(this.quad, this.camera);
    }

    /** Adds samples to each pixel of both images. */
    add(state: SphereState, samples: number) {
        const [from, to] = this.targets;
        const u = this.adding.uniforms;
        this.set(this.adding, state);
        u.lamp.value.set(...directionOf(state.lightAzimuth, state.lightElevation));
        u.previousA.value = from.textures[0];
        u.previousB.value = from.textures[1];
        u.frame.value = this.done;
        u.samples.value = samples;
        this.draw(this.adding, to);
        this.targets = [to, from];
        this.done += samples;
    }

    /** exp(mean ln(1e-5 + Lw)) and the greatest Lw of the original. */
    measure(): { average: number; greatest: number } {
        this.measuring.uniforms.image.value = this.targets[0].textures[0];
        this.measuring.uniforms.block.value = Math.ceil(this.size / BLOCKS);
        this.draw(this.measuring, this.blocks);
        const sums = this.floats(this.blocks, 0, BLOCKS);
        let [logs, count, greatest] = [0, 0, 0];
        for (let k = 0; k < sums.length; k += 4) {
            logs += sums[k];
            count += sums[k + 1];
            greatest = Math.max(greatest, sums[k + 2]);
        }
        return count > 0
            ? { average: Math.exp(logs / count), greatest }
            : { average: 1, greatest: 1 };
    }

    private floats(target: WebGLRenderTarget, which: number, size: number): Float32Array {
        if (target.texture.type === FloatType) {
            const pixels = new Float32Array(4 * size * size);
            this.renderer.readRenderTargetPixels(
                target,
                0,
                0,
                size,
                size,
                pixels,
                undefined,
                which,
            );
            return pixels;
        }
        const halves = new Uint16Array(4 * size * size);
        this.renderer.readRenderTargetPixels(target, 0, 0, size, size, halves, undefined, which);
        return Float32Array.from(halves, halfToFloat);
    }

    /** Linear R, G, B multiplied by A, bottom row first: 0 the original, 1 the reconstruction. */
    pixels(which: 0 | 1): Float32Array {
        return this.floats(this.targets[0], which, this.size);
    }

    /** Draws the original (0), the reconstruction (1) or the difference (2) on the canvas. */
    show(
        state: SphereState,
        mode: 0 | 1 | 2,
        tone: { average: number; greatest: number },
        backdrop: Triple,
    ) {
        const u = this.showing.uniforms;
        const photographic = state.tone === 'photographic';
        const scale = 2 ** state.exposure * (photographic ? KEY / tone.average : 1);
        this.set(this.showing, state);
        u.imageA.value = this.targets[0].textures[0];
        u.imageB.value = this.targets[0].textures[1];
        u.mode.value = mode;
        u.photographic.value = photographic;
        u.scale.value = scale;
        u.white.value = Math.max(scale * tone.greatest, 1e-6);
        u.range.value = state.range;
        u.backdrop.value.set(...backdrop);
        this.draw(this.showing, null);
    }
}

function halfToFloat(half: number): number {
    const sign = half & 0x8000 ? -1 : 1;
    const exponent = (half >> 10) & 31;
    const fraction = half & 1023;
    return exponent === 0
        ? sign * fraction * 2 ** -24
        : exponent === 31
          ? sign * Infinity
          : sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

// ---- the section of the page ----

const NAMES = ['Original', 'Reconstruction', 'Difference'] as const;

interface Panel {
    mode: 0 | 1 | 2;
    canvas: HTMLCanvasElement;
}

export const DEFAULT_STATE: SphereState = {
    lighting: 'lamp',
    lightAzimuth: -45,
    lightElevation: 45,
    viewAzimuth: 0,
    viewElevation: 0,
    exposure: 0,
    tone: 'photographic',
    range: 1,
};

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

    constructor(
        private readonly original: Table,
        private readonly reconstruction: Table | null,
    ) {
        this.renderer = new SphereRenderer(original, reconstruction);
        this.makePanels();
        this.makeControls();
        onTheme(() => this.refresh());
        new ResizeObserver(() => this.fitSize()).observe(this.panels[0].canvas);
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
        const pair = this.pairAt(
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

    /** Light and view at a place of the picture (-1 .. 1), in the frame of the surface. */
    private pairAt(x: number, y: number): { incident: Triple; outgoing: Triple } | null {
        const { state } = this;
        const [right, up, back] = cameraOf(state);
        const tangent = Math.tan(FIELD_OF_VIEW / 2);
        const distance = 1 / Math.sin(Math.atan(0.95 * tangent));
        const ray = normalised(
            [0, 1, 2].map((k) => (x * right[k] + y * up[k]) * tangent - back[k]) as Triple,
        );
        const eye = back.map((v) => v * distance) as Triple;
        const half = dot(eye, ray);
        const discriminant = half * half - dot(eye, eye) + 1;
        if (discriminant <= 0 || state.lighting !== 'lamp') {
            return null;
        }
        const t = -half - Math.sqrt(discriminant);
        const normal = normalised(eye.map((v, k) => v + t * ray[k]) as Triple);
        const lamp = directionOf(state.lightAzimuth, state.lightElevation);
        const tangentX = normalised(
            Math.abs(normal[1]) < 0.99 ? cross([0, 1, 0], normal) : cross([1, 0, 0], normal),
        );
        const tangentY = cross(normal, tangentX);
        const local = (v: Triple): Triple => [dot(v, tangentX), dot(v, tangentY), dot(v, normal)];
        const incident = local(lamp);
        const outgoing = local(ray.map((v) => -v) as Triple);
        return incident[2] > 0 && outgoing[2] > 0 ? { incident, outgoing } : null;
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
        if (!this.waiting) {
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

const dot = (a: Triple, b: Triple) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function normalised(v: Triple): Triple {
    const length = Math.hypot(...v);
    return [v[0] / length, v[1] / length, v[2] / length];
}
