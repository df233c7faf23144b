// The page of a material and its reconstruction: numbers, pixels, every control, pictures.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import {
    changes,
    choose,
    difference,
    fileOf,
    hasFile,
    json,
    launch,
    lookUpErrors,
    looksLike,
    open,
    picture,
    slide,
    spheresDone,
} from './browser.mjs';

let browser;
let page;
let complaints;

before(async () => {
    browser = await launch();
    ({ page, complaints } = await open(browser, 'page.html'));
});
after(async () => browser?.close());

test('the page passes its own check', async () => {
    assert.equal(await page.locator('#problem').isHidden(), true);
    assert.match(await page.locator('#precision').innerText(), /look-ups checked against gonio's/);
});

test('every section is there, named in the navigation', async () => {
    for (const section of ['spheres', 'hemisphere', 'slice', 'lobes', 'errors']) {
        assert.ok(await page.locator(`#${section}`).isVisible(), section);
        assert.ok(await page.locator(`nav a[href="#${section}"]`).isVisible(), section);
    }
    assert.equal(await page.locator('#figures').isVisible(), false);
});

test('the BRDF between bins is that of the C library', async () => {
    const worst = await lookUpErrors(page, json('values.json'));
    assert.equal(worst.wrong, 0, 'where there are data');
    assert.ok(worst.most < 0.52, `off by ${worst.most} steps`);
});

test('E6 of the tables in the page is what gonio compare finds', async () => {
    const [mine, theirs] = await page.evaluate(() => {
        const { tables, data } = window.gonioReport;
        const [a, b] = [tables.reference.rgba, tables.reconstruction.rgba];
        const scale = [1, 1.15, 1.66].map((s) => s / 1500);
        let [above, below] = [0, 0];
        for (let at = 0; at < a.length; at += 4) {
            for (let k = 0; k < 3 && a[at + 3] > 0 && b[at + 3] > 0; k++) {
                const g = Math.log1p(a[at + k] / scale[k]);
                above += (g - Math.log1p(b[at + k] / scale[k])) ** 2;
                below += g * g;
            }
        }
        return [100 * Math.sqrt(above / below), data.comparison.all[0]];
    });
    assert.ok(Math.abs(mine - theirs) < 1e-3 * theirs, `${mine} against ${theirs}`);
});

test('the deviations are the numbers of the file', async () => {
    const [low, high] = await page.evaluate(() => {
        const { deviation } = window.gonioReport.tables;
        return [deviation.atBin(10, 0, 90)[0], deviation.atBin(10, 45, 90)[2]];
    });
    assert.ok(Math.abs(low - 0.03) < 0.001, String(low));
    assert.ok(Math.abs(high - 0.13) < 0.001, String(high));
});

test('pixels of the sphere are those of the C library', async () => {
    const { size, pixels } = json('sphere.json');
    const found = await page.evaluate(
        ([wide]) => {
            const { SphereRenderer, tables, spheres } = window.gonioReport;
            const renderer = new SphereRenderer(tables.reference, tables.reconstruction, wide);
            const state = {
                ...spheres.state,
                lighting: 'lamp',
                lightAzimuth: -45,
                lightElevation: 45,
            };
            renderer.add({ ...state, viewAzimuth: 0, viewElevation: 0 }, 1);
            return [...renderer.pixels(0)];
        },
        [size],
    );
    let [compared, bad] = [0, 0];
    pixels.forEach((pixel, k) => {
        assert.equal(found[4 * k + 3], pixel ? 1 : 0, `coverage of pixel ${k}`);
        // Near the horizon a table has too few bins to tell.
        if (pixel && pixel[3] > 0.1 && pixel[4] > 0.1) {
            for (let channel = 0; channel < 3; channel++) {
                compared++;
                const off = Math.abs(found[4 * k + channel] - pixel[channel]);
                bad += off > 0.01 * pixel[channel] + 1e-4 ? 1 : 0;
            }
        }
    });
    assert.ok(compared > 9000, `${compared} compared`);
    assert.ok(bad < 0.002 * compared, `${bad} of ${compared} differ by more than 1 %`);
});

for (const [lighting, samples, tolerance] of [
    ['lamp', 16, 0.003],
    ['studio', 96, 0.01],
    ['sky', 96, 0.012],
]) {
    test(`the picture of the sphere (${lighting}) is that of gonio render`, async (t) => {
        if (!hasFile(`${lighting}.png`)) {
            t.skip('this gonio has no render');
            return;
        }
        const mine = await page.evaluate(
            ([light, count]) => {
                const { SphereRenderer, tables, spheres } = window.gonioReport;
                const renderer = new SphereRenderer(tables.reference, null, 96);
                const state = {
                    ...spheres.state,
                    lighting: light,
                    lightAzimuth: -45,
                    lightElevation: 45,
                };
                for (let k = 0; k < count; k += 8) {
                    renderer.add(state, 8);
                }
                renderer.show({ ...state, lighting: 'lamp' }, 0, renderer.measure(), [0, 0, 0]);
                return renderer.canvas.toDataURL('image/png').split(',')[1];
            },
            [lighting, samples],
        );
        const theirs = readFileSync(fileOf(`${lighting}.png`));
        const found = await difference(page, Buffer.from(mine, 'base64'), theirs, 48); // noise evens out
        t.diagnostic(`mean difference ${found.mean.toFixed(4)}`);
        assert.ok(found.mean < tolerance, `differs by ${found.mean.toFixed(4)} on average`);
    });
}

test('controls of the spheres', async () => {
    const original = '[data-sphere=original]';
    await changes(page, original, () => slide(page, 'lightAzimuth', 40));
    await changes(page, original, () => slide(page, 'lightElevation', 10));
    await changes(page, original, () => slide(page, 'viewAzimuth', 60));
    await changes(page, original, () => slide(page, 'viewElevation', 30));
    await spheresDone(page);
    await changes(page, original, () => slide(page, 'exposure', 2));
    await changes(page, original, () => choose(page, 'tone', 'none'));
    await choose(page, 'tone', 'photographic');
    await changes(page, '[data-sphere=difference]', () => slide(page, 'range', -2));
    assert.match(await page.locator('#range-low').innerText(), /0\.25/);
    for (const light of ['studio', 'sky', 'furnace', 'lamp']) {
        await changes(page, original, () => choose(page, 'lighting', light));
    }
    await page.locator('[data-control=reset]').click();
    assert.equal(await page.locator('input[data-control=lightAzimuth]').inputValue(), '-45');
    assert.equal(await page.locator('input[data-control=exposure]').inputValue(), '0');
});

test('spheres improve only while they are in view', async () => {
    const samples = () => page.evaluate(() => window.gonioReport.spheres.renderer.samplesDone);
    await page.locator('#errors').scrollIntoViewIfNeeded();
    await page.evaluate(() => window.scrollTo(0, document.body.scrollHeight));
    await slide(page, 'lightAzimuth', -44);
    await page.waitForTimeout(200); // for frames that must not be drawn
    const unseen = await samples();
    assert.ok(unseen >= 1 && unseen < 16, `${unseen} samples out of view`);
    assert.equal(await page.evaluate(() => document.documentElement.dataset.spheres), 'working');
    await spheresDone(page);
    assert.ok((await samples()) >= 16);
    await page.locator('[data-control=reset]').click();
});

test('dragging and keys move light and view', async () => {
    const sphere = page.locator('[data-sphere=original]');
    const value = (name) => page.locator(`input[data-control=${name}]`).inputValue().then(Number);
    const drag = async () => {
        await sphere.scrollIntoViewIfNeeded();
        const box = await sphere.boundingBox();
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        await page.mouse.down();
        await page.mouse.move(box.x + box.width / 2 + 40, box.y + box.height / 2 - 20, {
            steps: 2,
        });
        await page.mouse.up();
    };
    await drag();
    assert.ok((await value('lightAzimuth')) > -40 && (await value('lightElevation')) > 46);
    await choose(page, 'dragging', 'view');
    await drag();
    assert.ok((await value('viewAzimuth')) < 0);
    await choose(page, 'dragging', 'light');
    await page.locator('[data-control=reset]').click();
    await sphere.focus();
    await page.keyboard.press('ArrowRight');
    assert.equal(await value('lightAzimuth'), -40);
    await page.keyboard.press('Shift+ArrowUp');
    assert.equal(await value('viewElevation'), 5);
    await page.locator('[data-control=reset]').click();
    await sphere.hover();
    assert.match(await page.locator('#sphere-readout').innerText(), /θi .* original .* 1\/sr/);
});

test('the hemisphere tells of readings', async () => {
    const canvas = page.locator('#hemisphere-canvas');
    const readout = page.locator('#hemisphere-readout');
    await changes(page, '#hemisphere-canvas', () => slide(page, 'shown', 5));
    assert.match(await readout.innerText(), /Reading 5 of 24/);
    assert.match(await readout.innerText(), /light θ 16\.6°/);
    await changes(page, '#hemisphere-canvas', () =>
        page.locator('input[data-control=arcs]').click(),
    );
    await canvas.focus();
    await page.keyboard.press('Shift+ArrowLeft');
    assert.match(await readout.innerText(), /Reading 4 of 24/);
    await changes(page, '#hemisphere-canvas', () => page.keyboard.press('ArrowLeft'));
    await changes(page, '#hemisphere-canvas', () =>
        page.locator('[data-control=hemisphere-reset]').click(),
    );
    await slide(page, 'shown', 20);
    await page.locator('[data-control=play]').click();
    await page.waitForFunction(() =>
        /Reading 24/.test(document.querySelector('#hemisphere-readout').textContent),
    );
    await page.locator('input[data-control=arcs]').click();
    // Hovering: somewhere over the picture there is a mark.
    const box = await canvas.boundingBox();
    const told = new Set();
    for (let x = 0.25; x < 0.76; x += 0.1) {
        for (const y of [0.25, 0.4, 0.55]) {
            await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
            told.add(await readout.innerText());
        }
    }
    assert.ok(told.size > 2, 'hovering finds several readings');
    assert.match([...told].join(), /read\s+[\d.]+/);
});

test('controls of the image slice', async () => {
    const slice = '#slice-canvas';
    for (const layer of ['reconstruction', 'error', 'uncertainty', 'original']) {
        await changes(page, slice, () => choose(page, 'layer', layer));
    }
    for (const channel of ['R', 'G', 'B', 'colour', 'luminance']) {
        await changes(page, slice, () => choose(page, 'slice-channel', channel));
    }
    await changes(page, slice, () => slide(page, 'phi-d', 10));
    await changes(page, slice, () => page.locator('input[data-control=slice-log]').click());
    await changes(page, slice, () => page.locator('input[data-control=slice-marks]').click());
    await page.locator('input[data-control=slice-log]').click();
    await page.locator('input[data-control=slice-marks]').click();
    await slide(page, 'phi-d', 89);
    await page.locator(slice).focus();
    await page.keyboard.press('ArrowRight');
    const told = await page.locator('#slice-readout').innerText();
    assert.match(told, /θh 1\.47°, θd 10\.5°, φd 89\.5°/);
    assert.match(told, /original .* reconstruction .* error of g .* σ of g/);
    const value = await page.evaluate(
        () => window.gonioReport.tables.reference.atBin(11, 10, 89)[0],
    );
    assert.ok(told.includes(`original ${Number(value.toPrecision(3))}`), told);
    await page.keyboard.press('Shift+ArrowLeft');
    await page.locator(slice).blur();
});

test('controls of the lobes', async () => {
    const polar = '#lobe-polar';
    await changes(page, polar, () => slide(page, 'incidence', 60));
    for (const channel of ['R', 'G', 'B', 'luminance']) {
        await changes(page, polar, () => choose(page, 'lobe-channel', channel));
    }
    await changes(page, polar, () => page.locator('input[data-control=lobe-log]').click());
    await page.locator('input[data-control=lobe-log]').click();
    assert.equal(await page.locator('#lobe-polar .lobe-area').count(), 1, 'the band');
    const chart = page.locator('#lobe-chart .chart');
    await chart.focus();
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('ArrowRight');
    assert.match(await chart.locator('.u-legend').innerText(), /-89°/);
    await page.locator('#lobe-chart summary').click();
    await page.locator('#lobe-chart .numbers tr').nth(359).waitFor({ state: 'attached' });
    assert.equal(await page.locator('#lobe-chart .numbers tr').count(), 360);
    await slide(page, 'incidence', 30);
    await page.locator('#lobe-chart summary').click();
});

test('the errors are those of gonio compare', async () => {
    const e6 = await page.evaluate(() => window.gonioReport.data.comparison.all[0]);
    assert.ok((await page.locator('#error-rows').innerText()).includes(`${e6.toFixed(3)} %`));
});

test('every control can be reached by keyboard, and has a name', async () => {
    const nameless = await page.evaluate(() =>
        [...document.querySelectorAll('input, button, canvas[role], .chart')]
            .filter(
                (node) =>
                    node.tabIndex < 0 ||
                    !(
                        node.getAttribute('aria-label') ??
                        node.labels?.[0]?.textContent ??
                        node.textContent
                    ),
            )
            .map((node) => node.outerHTML.slice(0, 80)),
    );
    assert.deepEqual(nameless, []);
});

test('the theme can be chosen', async () => {
    const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    await choose(page, 'theme', 'dark');
    assert.equal(await background(), 'rgb(20, 23, 26)');
    await choose(page, 'theme', 'light');
    assert.equal(await background(), 'rgb(251, 251, 250)');
    await choose(page, 'theme', 'auto');
});

test('the pictures look as they did when they were looked at', async () => {
    await page.locator('[data-control=reset]').click();
    await slide(page, 'range', 0);
    await spheresDone(page);
    await looksLike(page, await picture(page, '[data-sphere=original]'), 'sphere', 0.02);
    await looksLike(page, await picture(page, '[data-sphere=difference]'), 'difference', 0.02);
    await looksLike(page, await picture(page, '#slice-canvas'), 'slice', 0.03);
    await looksLike(page, await picture(page, '#hemisphere-canvas'), 'hemisphere', 0.03);
    await looksLike(page, await picture(page, '#lobe-polar'), 'polar', 0.03);
});

test('no complaints and nothing from the network', () => assert.deepEqual(complaints, []));
