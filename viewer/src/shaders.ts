// The sphere on the GPU: one pass adds a sample to two images that share their random numbers, one
// measures them for the tone mapping, one shows them.
//
// Scene, camera and light are those of `gonio render` (include/gonio/render.h): x to the right, y up,
// z towards the viewer; a directional lamp of irradiance pi; the unit sphere fills 0.95 of the image.

export const vertex = /* glsl */ `
in vec3 position;
void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }
`;

const header = /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
const float PI = 3.14159265358979;
`;

/** Radiance from a direction of the world: the environments built into gonio (src/render). */
const environments = /* glsl */ `
uniform int lighting; // 0 lamp, 1 studio, 2 sky, 3 furnace
uniform float turn;   // to the right, about y
const float DEGREE = PI / 180.0;

// A rectangle at an azimuth and height, soft over a twentieth of its size; degrees.
float softBox(vec3 d, float azimuth, float elevation, vec2 halfSize)
{
    float across = mod(atan(d.x, d.z) / DEGREE - azimuth + 540.0, 360.0) - 180.0;
    float up = asin(clamp(d.y, -1.0, 1.0)) / DEGREE - elevation;
    vec2 edge = 1.0 - smoothstep(vec2(0.9), vec2(1.0), abs(vec2(across, up)) / halfSize);
    return edge.x * edge.y;
}

vec3 studio(vec3 d)
{
    float room = 0.12 + 0.10 * smoothstep(-0.6, 1.0, d.y);
    float key = 9.0 * softBox(d, -42.0, 38.0, vec2(24.0, 20.0));
    float fill = 3.0 * softBox(d, 62.0, 8.0, vec2(12.0, 34.0));
    float rim = 5.0 * softBox(d, 165.0, 30.0, vec2(40.0, 8.0));
    float ground = 0.08 * (1.0 - smoothstep(-0.5, 0.0, d.y));
    return room + vec3(1.00, 0.97, 0.92) * key + vec3(0.92, 0.98, 1.08) * fill +
           vec3(1.00, 0.98, 0.96) * rim + vec3(1.05, 1.00, 0.92) * ground;
}

vec3 sky(vec3 d)
{
    float cosine = min(dot(d, vec3(-0.5, 0.6, 0.6244997998)), 1.0);
    float above = smoothstep(-0.02, 0.02, d.y);
    float disc = 260.0 * (1.0 - smoothstep(2.6, 3.4, acos(cosine) / DEGREE));
    float glow = 1.2 * pow(max(cosine, 0.0), 48.0);
    vec3 air = mix(vec3(0.18, 0.38, 0.85), vec3(0.85, 0.90, 1.00), exp(-4.0 * max(d.y, 0.0)));
    return mix(vec3(0.20, 0.16, 0.12), air + vec3(1.0, 0.92, 0.78) * (disc + glow), above);
}

vec3 turned(vec3 d, float sense)
{
    float c = cos(turn), s = sense * sin(turn);
    return vec3(c * d.x + s * d.z, d.y, -s * d.x + c * d.z);
}

vec3 environment(vec3 d)
{
    vec3 own = turned(d, 1.0);
    return lighting == 1 ? studio(own) : lighting == 2 ? sky(own) : vec3(1.0);
}

// What is brightest: a rectangle, azimuths and sines of heights from .xz to .yw.
vec4 brightest()
{
    return lighting == 1 ? vec4(-66.0 * DEGREE, -18.0 * DEGREE, sin(18.0 * DEGREE), sin(58.0 * DEGREE))
                         : vec4(-0.749, -0.601, 0.552, 0.647); // about the sun
}
`;

/** Look-ups: a trilinear texture in (phi_d, theta_d, sqrt theta_h), alpha 1 where there are data. */
const lookUp = /* glsl */ `
uniform sampler3D original;
uniform sampler3D reconstruction;
uniform bool paired;

// Where in the table; both directions are unit vectors in the frame of the normal.
vec3 placeInTable(vec3 i, vec3 o)
{
    vec3 h = normalize(i + o);
    float sine = length(h.xy);
    vec2 phi = sine > 0.0 ? h.xy / sine : vec2(1.0, 0.0);
    float x = dot(i, vec3(h.z * phi, -sine));
    float y = dot(i, vec3(-phi.y, phi.x, 0.0));
    float thetaH = atan(sine, h.z);
    float thetaD = atan(length(vec2(x, y)), dot(i, h));
    float phiD = x == 0.0 && y == 0.0 ? 0.0 : atan(y, x);
    return vec3(phiD / PI, thetaD * 2.0 / PI, sqrt(max(thetaH, 0.0) * 2.0 / PI));
}

// Near the poles of phi_d, which mean nothing at theta_h = 0 and theta_d = 0, its mean takes over.
vec4 entryAt(sampler3D table, vec3 place)
{
    float first = 0.5 / 90.0; // the first centres
    float across = min(place.z / first, 1.0);
    float meaning = across * across * min(place.y / first, 1.0);
    vec4 value = meaning * textureLod(table, place, 0.0);
    for (int sector = 0; meaning < 1.0 && sector < 12; sector++) {
        vec3 middle = vec3((float(sector) + 0.5) / 12.0, place.yz);
        value += (1.0 - meaning) / 12.0 * textureLod(table, middle, 0.0);
    }
    return value;
}

vec3 valueAt(sampler3D table, vec3 place)
{
    vec4 value = entryAt(table, place);
    return value.a > 0.0 ? value.rgb / value.a : vec3(0.0);
}
`;

/** Adds samples to both images. */
export const accumulate = /* glsl */ `${header}${environments}${lookUp}
uniform sampler2D previousA;
uniform sampler2D previousB;
uniform sampler2D highlight; // 90 x 1: distribution function of theta_h bins, density of h (1/sr)
uniform float frame;         // samples so far
uniform int samples;         // to add
uniform vec2 size;           // pixels
uniform mat3 camera;         // right, up, towards the viewer
uniform float distanceOfViewer;
uniform float tangent;       // of half the field of view
uniform vec3 lamp;           // unit vector towards it
layout(location = 0) out vec4 sumA;
layout(location = 1) out vec4 sumB;

// Random numbers in 0 .. 1 (Jarzynski and Olano 2020, pcg3d).
uvec3 state;
vec3 random()
{
    state = state * 1664525u + 1013904223u;
    state.x += state.y * state.z; state.y += state.z * state.x; state.z += state.x * state.y;
    state ^= state >> 16u;
    state.x += state.y * state.z; state.y += state.z * state.x; state.z += state.x * state.y;
    return vec3(state >> 8u) * (1.0 / 16777216.0);
}

int binOf(float thetaH) { return clamp(int(90.0 * sqrt(thetaH * 2.0 / PI)), 0, 89); }
float lowerEdge(int bin) { float t = float(bin) / 90.0; return t * t * PI / 2.0; }

// Densities of the ways to choose a direction i of the light: by the cosine, by h, in the brightest
// part of the environment (world).
float cosineDensity(vec3 i) { return max(i.z, 0.0) / PI; }
float highlightDensity(vec3 i, vec3 o)
{
    vec3 h = normalize(i + o);
    float density = texelFetch(highlight, ivec2(binOf(atan(length(h.xy), h.z)), 0), 0).g;
    return density / (4.0 * max(dot(i, h), 1e-6));
}

float brightestDensity(vec3 world)
{
    if (lighting == 3) { return 0.0; }
    vec4 box = brightest();
    vec3 own = turned(world, 1.0);
    float azimuth = atan(own.x, own.z);
    bool inside = azimuth > box.x && azimuth < box.y && own.y > box.z && own.y < box.w;
    return inside ? 1.0 / ((box.y - box.x) * (box.w - box.z)) : 0.0;
}

vec3 byBrightest(vec2 u)
{
    vec4 box = brightest();
    float azimuth = mix(box.x, box.y, u.x), y = mix(box.z, box.w, u.y), r = sqrt(1.0 - y * y);
    return turned(vec3(r * sin(azimuth), y, r * cos(azimuth)), -1.0);
}

vec3 byCosine(vec2 u)
{
    float r = sqrt(u.x), phi = 2.0 * PI * u.y;
    return vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x));
}

vec3 byHighlight(vec3 u, vec3 o)
{
    int low = 0, high = 89;
    for (int k = 0; k < 7; k++) { // the first bin whose distribution function exceeds u
        int middle = (low + high) / 2;
        if (texelFetch(highlight, ivec2(middle, 0), 0).r > u.x) { high = middle; } else { low = min(middle + 1, high); }
    }
    float z = mix(cos(lowerEdge(high)), cos(lowerEdge(high + 1)), u.y);
    float r = sqrt(max(1.0 - z * z, 0.0)), phi = 2.0 * PI * u.z;
    vec3 h = vec3(r * cos(phi), r * sin(phi), z);
    return 2.0 * dot(o, h) * h - o;
}

mat3 frameAbout(vec3 n)
{
    vec3 t = normalize(abs(n.y) < 0.99 ? cross(vec3(0.0, 1.0, 0.0), n) : vec3(1.0, 0.0, 0.0));
    t = normalize(t - dot(t, n) * n);
    return mat3(t, cross(n, t), n);
}

// Light that leaves towards o for light of radiance (or irradiance) e from i, weighted.
void shade(vec3 i, vec3 o, vec3 e, inout vec3 a, inout vec3 b)
{
    vec3 place = placeInTable(i, o);
    a += valueAt(original, place) * e;
    if (paired) { b += valueAt(reconstruction, place) * e; }
}

void shadeFrom(vec3 i, vec3 o, mat3 frame_, inout vec3 a, inout vec3 b)
{
    if (i.z <= 0.0) { return; }
    // Balance heuristic of one sample each (Veach and Guibas 1995).
    vec3 world = frame_ * i;
    float density = cosineDensity(i) + highlightDensity(i, o) + brightestDensity(world);
    shade(i, o, environment(world) * i.z / density, a, b);
}

void sampleOnce(inout vec4 a, inout vec4 b)
{
    vec2 pixel = (gl_FragCoord.xy - 0.5 + (samples == 1 && frame < 0.5 ? vec2(0.5) : random().xy)) / size * 2.0 - 1.0;
    vec3 ray = normalize(camera * vec3(pixel * tangent, -1.0));
    vec3 eye = camera[2] * distanceOfViewer;
    float half_ = dot(eye, ray);
    float discriminant = half_ * half_ - dot(eye, eye) + 1.0;
    if (discriminant <= 0.0) { return; }
    vec3 normal = normalize(eye + (-half_ - sqrt(discriminant)) * ray);
    mat3 local = frameAbout(normal);
    vec3 o = -ray * local;
    vec3 x = vec3(0.0), y = vec3(0.0);
    if (o.z > 0.0 && lighting == 0) {
        vec3 i = lamp * local;
        if (i.z > 0.0) { shade(i, o, vec3(PI * i.z), x, y); }
    } else if (o.z > 0.0) {
        vec3 u = random();
        shadeFrom(byCosine(u.xy), o, local, x, y);
        shadeFrom(byHighlight(random(), o), o, local, x, y);
        if (lighting != 3) { shadeFrom(byBrightest(random().xy) * local, o, local, x, y); }
    }
    a += vec4(x, 1.0);
    b += vec4(y, 1.0);
}

void main()
{
    state = uvec3(gl_FragCoord.xy, uint(frame) * 7919u + 17u);
    random();
    vec4 a = vec4(0.0), b = vec4(0.0);
    for (int k = 0; k < samples; k++) { sampleOnce(a, b); }
    float share = 1.0 / (frame + float(samples));
    ivec2 at = ivec2(gl_FragCoord.xy);
    sumA = frame < 0.5 ? a * share : texelFetch(previousA, at, 0) * (frame * share) + a * share;
    sumB = frame < 0.5 ? b * share : texelFetch(previousB, at, 0) * (frame * share) + b * share;
}
`;

/** A grid of blocks: sum of ln(1e-5 + Lw), pixels that are not black, greatest Lw. */
export const measure = /* glsl */ `${header}
uniform sampler2D image;
uniform int block;
out vec4 sums;
void main()
{
    ivec2 from = ivec2(gl_FragCoord.xy) * block;
    ivec2 size = textureSize(image, 0);
    sums = vec4(0.0);
    for (int y = 0; y < block; y++) {
        for (int x = 0; x < block; x++) {
            ivec2 at = from + ivec2(x, y);
            if (at.x >= size.x || at.y >= size.y) { continue; }
            vec4 c = texelFetch(image, at, 0);
            float luminance = dot(c.rgb, vec3(0.2126, 0.7152, 0.0722));
            if (c.a > 0.0 && luminance > 0.0) {
                luminance /= c.a;
                sums += vec4(log(1e-5 + luminance), 1.0, 0.0, 0.0);
                sums.z = max(sums.z, luminance);
            }
        }
    }
}
`;

/** Tone mapping (Reinhard et al. 2002, eqs. 1, 2, 4) or plain exposure; or the difference in stops. */
export const show = /* glsl */ `${header}${environments}
uniform vec2 size;
uniform mat3 camera;
uniform float tangent;
uniform sampler2D imageA;
uniform sampler2D imageB;
uniform sampler2D colours; // of differences, -1 .. 1
uniform int mode;          // 0: A, 1: B, 2: difference of B from A
uniform bool photographic;
uniform float scale;       // key / average, or the plain factor
uniform float white;
uniform float range;       // stops at either end of the colours
uniform vec3 backdrop;     // linear; where no environment is shown
out vec4 shown;

vec3 toned(vec3 c)
{
    if (photographic) {
        float l = scale * dot(c, vec3(0.2126, 0.7152, 0.0722));
        c *= scale * (1.0 + l / (white * white)) / (1.0 + l);
    } else {
        c *= scale;
    }
    return clamp(c, 0.0, 1.0);
}

vec3 encoded(vec3 c)
{
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308))));
}

void main()
{
    vec4 a = texelFetch(imageA, ivec2(gl_FragCoord.xy), 0);
    vec4 b = texelFetch(imageB, ivec2(gl_FragCoord.xy), 0);
    vec3 grey = vec3(0.2126, 0.7152, 0.0722);
    if (mode == 2) {
        float from = dot(a.rgb, grey), to = dot(b.rgb, grey);
        float stops = a.a <= 0.5 || max(from, to) <= 1e-6 ? 0.0 : log2(max(to, 1e-6) / max(from, 1e-6));
        vec3 c = texture(colours, vec2(clamp(0.5 + 0.5 * stops / range, 0.002, 0.998), 0.5)).rgb;
        bool lit = max(from, to) > 1e-6;
        shown = vec4(mix(encoded(backdrop), lit ? c : vec3(0.5), lit ? a.a : 0.25 * a.a), 1.0);
        return;
    }
    vec4 c = mode == 0 ? a : b;
    // Premultiplied colours are toned unmultiplied, as gonio render does.
    vec3 surface = c.a > 0.0 ? toned(c.rgb / c.a) * c.a : vec3(0.0);
    vec3 behind = backdrop;
    if (lighting != 0 && c.a < 1.0) {
        vec2 pixel = gl_FragCoord.xy / size * 2.0 - 1.0;
        behind = toned(environment(normalize(camera * vec3(pixel * tangent, -1.0))));
    }
    shown = vec4(encoded(surface + behind * (1.0 - c.a)), 1.0);
}
`;
