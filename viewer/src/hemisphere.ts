// Section 2: where was measured, as pairs of light and view on the hemisphere, in measuring order.
import {
    BufferGeometry,
    CanvasTexture,
    Color,
    Float32BufferAttribute,
    Group,
    InstancedMesh,
    Line,
    LineBasicMaterial,
    LineLoop,
    Matrix4,
    MeshBasicMaterial,
    OctahedronGeometry,
    PerspectiveCamera,
    Scene,
    SphereGeometry,
    Sprite,
    SpriteMaterial,
    Vector3,
    WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { degrees, radians, vectorOf } from './brdf';
import { themeColour, valueColours } from './colour';
import { byId, button, choice, element, short, slider, toggle, type Choice } from './controls';
import type { Angles, Reading } from './data';
import { onTheme } from './theme';
import { TurnDial } from './turns';

export interface Plan {
    name: string;
    readings: Reading[];
}

interface Place {
    reading: number;
    position: Vector3;
}

const HOME = new Vector3(1.75, -2.9, 2.0);
const NEAR = 16; // pixels from a mark that still count as on it
const CHANNELS = ['R', 'G', 'B'];

const vector = (angles: Angles) => new Vector3(...vectorOf(angles));

export class HemisphereSection {
    private readonly scene = new Scene();
    private readonly camera = new PerspectiveCamera(32, 1, 0.1, 20);
    private readonly renderer: WebGLRenderer;
    private readonly orbit: OrbitControls;
    private readonly backdrop = new Group();
    private readonly marks = new Group();
    private readonly highlight = new Group();
    private places: Place[] = [];
    private readings: Reading[];
    private shown: Choice<number> | null = null;
    private shownCount = 0;
    /** The readings of one azimuth of the sample; null for all. */
    private chosen: Set<number> | null = null;
    private readonly dial: TurnDial | null;
    private selected = -1;
    private arcs = true;
    private timer = 0;

    /** turns: the azimuth of the sample matters. */
    constructor(
        private readonly plans: Plan[],
        turns: boolean,
    ) {
        this.readings = plans[0].readings;
        const canvas = byId<HTMLCanvasElement>('hemisphere-canvas');
        this.renderer = new WebGLRenderer({
            canvas,
            antialias: true,
            alpha: true,
            preserveDrawingBuffer: true,
        });
        this.camera.up.set(0, 0, 1);
        this.camera.position.copy(HOME);
        this.orbit = new OrbitControls(this.camera, canvas);
        this.orbit.target.set(0, 0, 0.3);
        this.orbit.enablePan = false;
        this.orbit.enableZoom = false; // the wheel scrolls the page
        this.orbit.update();
        canvas.style.touchAction = 'pan-y';
        this.orbit.addEventListener('change', () => this.draw());
        this.scene.add(this.backdrop, this.marks, this.highlight);
        this.makeControls();
        this.dial = turns ? new TurnDial((readings) => this.showOnly(readings)) : null;
        this.listen(canvas);
        onTheme(() => this.rebuild());
        new ResizeObserver(() => this.fitSize(canvas)).observe(canvas);
        this.takePlan(plans[0]);
    }

    private makeControls() {
        const parent = byId('hemisphere-controls');
        if (this.plans.length > 1) {
            const options = this.plans.map((plan, k) => [String(k), plan.name] as const);
            choice(parent, 'plan', 'Plan', options, '0', (value) =>
                this.takePlan(this.plans[Number(value)]),
            );
        }
        const box = element('div', { class: 'slot' });
        parent.append(box);
        this.slot = box;
        button(parent, 'play', 'Play in measuring order', () => this.play());
        toggle(parent, 'arcs', 'Join light and view', true, (value) => {
            this.arcs = value;
            this.rebuild();
        });
        button(parent, 'hemisphere-reset', 'Reset the view', () => {
            this.camera.position.copy(HOME);
            this.orbit.update();
            this.draw();
        });
    }
    private slot: HTMLElement | null = null;

    private takePlan(plan: Plan) {
        this.readings = plan.readings;
        const count = plan.readings.length;
        this.slot?.replaceChildren();
        this.shown = slider(
            this.slot!,
            'shown',
            'Measured so far',
            [1, count, 1],
            count,
            (v) => `${v} of ${count}`,
            (value) => {
                this.stop();
                this.showFirst(value);
            },
        );
        this.stop();
        this.dial?.show(plan.readings);
        this.chosen = null;
        this.selected = -1;
        this.shownCount = count;
        this.rebuild();
        this.tell();
    }

    /** The readings of one azimuth of the sample, or all. */
    private showOnly(readings: Set<number> | null) {
        this.chosen = readings;
        this.rebuild();
        this.tell();
    }

    private isShown(reading: number): boolean {
        return reading >= 0 && reading < this.shownCount && (this.chosen?.has(reading) ?? true);
    }

    /** The numbers of the readings that are shown, in measuring order. */
    private shownReadings(): number[] {
        return [...this.readings.keys()].filter((k) => this.isShown(k));
    }

    private showFirst(count: number) {
        this.shownCount = count;
        this.selected = count - 1;
        this.rebuild();
        this.tell();
    }

    private play() {
        if (this.timer !== 0) {
            this.stop();
            return;
        }
        let next = this.shownCount < this.readings.length ? this.shownCount : 0;
        const button = document.querySelector('[data-control=play]')!;
        button.textContent = 'Stop';
        this.timer = window.setInterval(
            () => {
                next++;
                this.shown?.set(next);
                this.showFirst(next);
                if (next >= this.readings.length) {
                    this.stop();
                }
            },
            Math.max(40, Math.min(400, 12000 / this.readings.length)),
        );
    }

    private stop() {
        window.clearInterval(this.timer);
        this.timer = 0;
        const button = document.querySelector('[data-control=play]');
        if (button) {
            button.textContent = 'Play in measuring order';
        }
    }

    // ---- the scene ----

    private rebuild() {
        for (const group of [this.backdrop, this.marks]) {
            group.clear();
        }
        this.makeBackdrop();
        this.makeMarks();
        this.select(this.selected);
    }

    private makeBackdrop() {
        const faint = new LineBasicMaterial({ color: themeColour('grid') });
        for (let theta = 30; theta <= 90; theta += 30) {
            const circle = Array.from({ length: 96 }, (_, k) =>
                vector([radians(theta), (k / 48) * Math.PI]),
            );
            this.backdrop.add(new LineLoop(new BufferGeometry().setFromPoints(circle), faint));
            this.label(`${theta}°`, [radians(theta), radians(-52)], 1.04);
        }
        for (let phi = 0; phi < 180; phi += 30) {
            const arc = Array.from({ length: 65 }, (_, k) =>
                vector([((k - 32) / 64) * Math.PI, radians(phi)]),
            );
            this.backdrop.add(new Line(new BufferGeometry().setFromPoints(arc), faint));
        }
        for (const phi of [0, 90, 180, 270]) {
            this.label(`φ ${phi}°`, [Math.PI / 2, radians(phi)], 1.14);
        }
        this.label('normal', [0, 0], 1.09);
    }

    private label(text: string, at: Angles, radius: number) {
        const canvas = element('canvas', { width: '192', height: '64' });
        const context = canvas.getContext('2d')!;
        context.font = '34px system-ui, sans-serif';
        context.textAlign = 'center';
        context.textBaseline = 'middle';
        context.fillStyle = themeColour('muted');
        context.fillText(text, 96, 32);
        const sprite = new Sprite(
            new SpriteMaterial({ map: new CanvasTexture(canvas), depthTest: false }),
        );
        sprite.scale.set(0.36, 0.12, 1);
        sprite.position.copy(vector(at).multiplyScalar(radius));
        this.backdrop.add(sprite);
    }

    private makeMarks() {
        const shown = this.shownReadings();
        const light = new MeshBasicMaterial({ color: themeColour('light-mark') });
        const view = new MeshBasicMaterial({ color: themeColour('view-mark') });
        const size = shown.length > 300 ? 0.013 : 0.022;
        const lights = new InstancedMesh(new OctahedronGeometry(size * 1.35), light, shown.length);
        const views = new InstancedMesh(new SphereGeometry(size, 12, 8), view, shown.length);
        this.places = [];
        shown.forEach((which, k) => {
            const reading = this.readings[which];
            const [i, o] = [vector(reading.incident), vector(reading.outgoing)];
            lights.setMatrixAt(k, new Matrix4().makeTranslation(i.x, i.y, i.z));
            views.setMatrixAt(k, new Matrix4().makeTranslation(o.x, o.y, o.z));
            this.places.push({ reading: which, position: i }, { reading: which, position: o });
        });
        this.marks.add(lights, views);
        if (this.arcs) {
            shown.forEach((which) => {
                const share = this.readings.length > 1 ? which / (this.readings.length - 1) : 0;
                const material = new LineBasicMaterial({
                    color: new Color(valueColours(0.1 + 0.8 * share)),
                    transparent: true,
                    opacity: shown.length > 200 ? 0.25 : 0.6,
                });
                this.marks.add(new Line(arcOf(this.readings[which]), material));
            });
        }
    }

    private select(which: number) {
        this.selected = this.isShown(which) ? which : -1;
        this.highlight.clear();
        const reading = this.readings[this.selected];
        if (reading) {
            const colour = themeColour('text');
            const ring = new MeshBasicMaterial({ color: colour, wireframe: true });
            for (const angles of [reading.incident, reading.outgoing]) {
                const line = new BufferGeometry().setFromPoints([new Vector3(), vector(angles)]);
                this.highlight.add(new Line(line, new LineBasicMaterial({ color: colour })));
            }
            for (const angles of [reading.incident, reading.outgoing]) {
                const mark = new InstancedMesh(new SphereGeometry(0.045, 10, 6), ring, 1);
                const at = vector(angles);
                mark.setMatrixAt(0, new Matrix4().makeTranslation(at.x, at.y, at.z));
                this.highlight.add(mark);
            }
            this.highlight.add(new Line(arcOf(reading), new LineBasicMaterial({ color: colour })));
        }
        this.draw();
    }

    private draw() {
        this.renderer.render(this.scene, this.camera);
    }

    private fitSize(canvas: HTMLCanvasElement) {
        const [width, height] = [canvas.clientWidth, canvas.clientHeight];
        this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        this.camera.fov = width < height * 1.15 ? 40 : 34;
        this.camera.updateProjectionMatrix();
        this.draw();
    }

    // ---- pointing ----

    private listen(canvas: HTMLCanvasElement) {
        canvas.addEventListener('pointermove', (event) => {
            if (event.buttons === 0) {
                this.pick(canvas, event);
            }
        });
        canvas.addEventListener('pointerdown', (event) => this.pick(canvas, event));
        canvas.addEventListener('keydown', (event) => {
            const step = {
                ArrowLeft: [-1, 0],
                ArrowRight: [1, 0],
                ArrowUp: [0, 1],
                ArrowDown: [0, -1],
            }[event.key];
            if (step && event.shiftKey) {
                this.walk(step[0] + step[1]);
            } else if (step) {
                this.turn(step[0] * 0.15, step[1] * 0.12);
            } else {
                return;
            }
            event.preventDefault();
        });
    }

    /** The mark under the pointer becomes the selected one. */
    private pick(canvas: HTMLCanvasElement, event: PointerEvent) {
        let best = NEAR;
        let found = -1;
        for (const place of this.places) {
            const screen = place.position.clone().project(this.camera);
            const x = ((screen.x + 1) / 2) * canvas.clientWidth - event.offsetX;
            const y = ((1 - screen.y) / 2) * canvas.clientHeight - event.offsetY;
            const distance = Math.hypot(x, y) + 2 * screen.z; // of two at one place, the nearer
            if (distance < best) {
                best = distance;
                found = place.reading;
            }
        }
        if (found >= 0 && found !== this.selected) {
            this.select(found);
            this.tell();
        }
    }

    /** The next or the previous reading. */
    private walk(step: number) {
        const shown = this.shownReadings();
        if (shown.length > 0) {
            const at = shown.indexOf(this.selected);
            const next = at < 0 ? (step > 0 ? 0 : -1) : at + step;
            this.select(shown[(next + shown.length) % shown.length]);
            this.tell();
        }
    }

    private turn(azimuth: number, elevation: number) {
        const offset = this.camera.position.clone().sub(this.orbit.target);
        const radius = offset.length();
        const polar = Math.min(Math.max(Math.acos(offset.z / radius) - elevation, 0.02), 1.6);
        const around = Math.atan2(offset.y, offset.x) + azimuth;
        offset.set(
            Math.sin(polar) * Math.cos(around),
            Math.sin(polar) * Math.sin(around),
            Math.cos(polar),
        );
        this.camera.position.copy(this.orbit.target).addScaledVector(offset, radius);
        this.orbit.update();
        this.draw();
    }

    /** What is known of the selected reading. */
    private tell() {
        const reading = this.readings[this.selected];
        const readout = byId('hemisphere-readout');
        readout.replaceChildren();
        if (!reading) {
            readout.textContent =
                'Point at a mark, or press Shift with an arrow key, to see a reading.';
            return;
        }
        const angle = ([theta, phi]: Angles) =>
            `θ ${degrees(theta).toFixed(1)}°, φ ${degrees(phi).toFixed(1)}°`;
        readout.append(
            element('strong', {}, `Reading ${this.selected + 1} of ${this.readings.length}`),
            element(
                'div',
                {},
                `light ${angle(reading.incident)} · view ${angle(reading.outgoing)}`,
            ),
        );
        readout.append(valueTable(reading));
    }
}

/** What was read, and what the tables hold there. */
function valueTable(reading: Reading): HTMLElement {
    const table = element('table', { class: 'small' });
    const head = element('tr', {}, element('th', {}, '1/sr'));
    CHANNELS.forEach((name, channel) => {
        const planned = reading.channel === channel || reading.channel < 0;
        head.append(element('th', { scope: 'col' }, planned ? `${name} (planned)` : name));
    });
    table.append(head);
    for (const [name, values] of [
        ['read', reading.value],
        ['original', reading.reference],
        ['reconstruction', reading.reconstruction],
    ] as const) {
        if (values?.some((value) => value !== null)) {
            const cells = values.map((v) => element('td', {}, v === null ? '–' : short(v)));
            table.append(element('tr', {}, element('th', { scope: 'row' }, name), ...cells));
        }
    }
    return table.rows.length > 1 ? table : element('span');
}

/** From the light to the view on the hemisphere. */
function arcOf(reading: Reading): BufferGeometry {
    const [i, o] = [vector(reading.incident), vector(reading.outgoing)];
    const angle = i.angleTo(o);
    const sine = Math.sin(angle);
    const points: number[] = [];
    for (let k = 0; k <= 24; k++) {
        const t = k / 24;
        const [a, b] =
            sine > 1e-6
                ? [Math.sin((1 - t) * angle) / sine, Math.sin(t * angle) / sine]
                : [1 - t, t];
        points.push(...i.clone().multiplyScalar(a).addScaledVector(o, b));
    }
    return new BufferGeometry().setAttribute('position', new Float32BufferAttribute(points, 3));
}
