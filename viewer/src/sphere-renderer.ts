// Original, reconstruction and their difference as spheres, drawn by WebGL.
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
import { luminance, PHI_D_BINS, THETA_D_BINS, THETA_H_BINS, radians, type Table } from './brdf';
import { differenceColours, ramp } from './colour';
import type { Triple } from './data';
import * as shaders from './shaders';
import {
    cameraOf,
    DEFAULT_STATE,
    directionOf,
    FIELD_OF_VIEW,
    LIGHTINGS,
    type SphereState,
} from './sphere-state';

const KEY = 0.18;
const BLOCKS = 32;

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
