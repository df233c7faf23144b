// What the tests of the page share: the browser, pages from disk, pictures compared.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const folder = process.env.PAGES;
const PATIENCE = 120000; // software rendering on a busy machine

export const fileOf = (name) => `${folder}/${name}`;
export const hasFile = (name) => existsSync(fileOf(name));
export const json = (name) => JSON.parse(readFileSync(fileOf(name), 'utf8'));

/** Root cannot have Chromium's sandbox. */
export function launch() {
    return chromium.launch({
        executablePath: process.env.CHROMIUM,
        args: [
            ...(process.getuid() === 0 ? ['--no-sandbox'] : []),
            '--use-angle=swiftshader',
            '--enable-unsafe-swiftshader',
            '--ignore-gpu-blocklist',
            '--disable-gpu-compositing',
            '--force-color-profile=srgb',
            '--hide-scrollbars',
        ],
    });
}

/** Opens a report from disk; what the console complains of and what is asked of the network is kept. */
export async function open(browser, name, options = {}) {
    const page = await browser.newPage({
        viewport: { width: 900, height: 800 },
        reducedMotion: 'reduce',
        ...options,
    });
    page.setDefaultTimeout(PATIENCE);
    const complaints = [];
    page.on('console', (message) => {
        // Reading pixels back is slow, and Chromium says so.
        if (
            ['error', 'warning'].includes(message.type()) &&
            !message.text().includes('GPU stall')
        ) {
            complaints.push(message.text());
        }
    });
    page.on('pageerror', (error) => complaints.push(String(error)));
    page.on('request', (request) => {
        if (!/^(file|data|blob):/.test(request.url())) {
            complaints.push(`asks for ${request.url()}`);
        }
    });
    await page.goto(pathToFileURL(fileOf(name)).href);
    await page.waitForSelector('html[data-ready=yes]', { timeout: PATIENCE });
    return { page, complaints };
}

/** Until the spheres, which only improve in view, are done. */
export async function spheresDone(page) {
    await page.locator('#sphere-panels').scrollIntoViewIfNeeded();
    await page.waitForSelector('html[data-spheres=finished]', { timeout: PATIENCE });
}

/** A PNG of an element, as it is on the screen. */
export async function picture(page, selector) {
    await page.locator(selector).scrollIntoViewIfNeeded();
    return page.locator(selector).screenshot();
}

/** Mean and greatest difference of two PNGs (0 .. 1), both made as small as `width` so that fonts and
 * antialiasing do not count. */
export function difference(page, a, b, width) {
    return page.evaluate(
        async ([first, second, wide]) => {
            const load = async (base64) => {
                const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
                return createImageBitmap(new Blob([bytes], { type: 'image/png' }));
            };
            const images = [await load(first), await load(second)];
            const ratio = (image) => image.height / image.width;
            if (Math.abs(ratio(images[0]) / ratio(images[1]) - 1) > 0.1) {
                return { mean: 1, greatest: 1 };
            }
            const high = Math.round(wide * ratio(images[0]));
            const data = images.map((image) => {
                const canvas = new OffscreenCanvas(wide, high);
                const context = canvas.getContext('2d');
                context.imageSmoothingQuality = 'high';
                context.drawImage(image, 0, 0, wide, high);
                return context.getImageData(0, 0, wide, high).data;
            });
            let [sum, greatest] = [0, 0];
            data[0].forEach((value, k) => {
                const d = Math.abs(value - data[1][k]) / 255;
                sum += d;
                greatest = Math.max(greatest, d);
            });
            return { mean: sum / ((data[0].length * 3) / 4), greatest };
        },
        [a.toString('base64'), b.toString('base64'), width],
    );
}

/** Compares with the picture that was looked at; UPDATE=1 replaces it. */
export async function looksLike(page, png, name, tolerance) {
    const path = fileURLToPath(new URL(`screenshots/${name}.png`, import.meta.url));
    if (process.env.UPDATE) {
        writeFileSync(path, png);
        return;
    }
    const found = await difference(page, readFileSync(path), png, 64);
    assert.ok(found.mean < tolerance, `${name}: differs by ${found.mean.toFixed(4)} on average`);
}

/** Sets a slider as a user's hand does. */
export async function slide(page, control, value) {
    await page.locator(`input[data-control=${control}]`).evaluate((input, to) => {
        input.value = String(to);
        input.dispatchEvent(new Event('input', { bubbles: true }));
    }, value);
}

export async function choose(page, control, text) {
    await page
        .locator(`[data-control=${control}] label`, { hasText: new RegExp(`^${text}$`) })
        .click();
}

/** A canvas or SVG as text, to see whether it has changed. */
export function look(page, selector) {
    return page
        .locator(selector)
        .evaluate((node) =>
            node instanceof HTMLCanvasElement ? node.toDataURL() : node.innerHTML,
        );
}

/** What an action changes; fails if it is nothing. */
export async function changes(page, selector, action) {
    const before = await look(page, selector);
    await action();
    await page.waitForFunction(
        ([at, old]) => {
            const node = document.querySelector(at);
            return (node instanceof HTMLCanvasElement ? node.toDataURL() : node.innerHTML) !== old;
        },
        [selector, before],
        { timeout: PATIENCE },
    );
}

/**
 * Of [theta_i, phi_i, theta_o, phi_o, R, G, B, found] of the C library: how far look-ups in the page
 * are off at most, in steps, half of which is what rounding costs; and how often one side has none.
 */
export const lookUpErrors = (page, rows) =>
    page.evaluate((pairs) => {
        const { tables, data } = window.gonioReport;
        const scale = [1, 1.15, 1.66].map((s) => s / 1500);
        let [most, wrong] = [0, 0];
        for (const [ti, pi, to, po, r, g, b, found] of pairs) {
            const value = tables.reference.atPair([ti, pi], [to, po]);
            wrong += (value !== null) !== found ? 1 : 0;
            if (value && found) {
                [r, g, b].forEach((rho, k) => {
                    const error = Math.abs(value[k] - rho) / (rho + scale[k]) / data.reference.step;
                    most = Math.max(most, error);
                });
            }
        }
        return { most, wrong };
    }, rows);
