// Checks of the engine's threads in the page: the same bits with any number of them, and pages that cannot have any.
import assert from "node:assert/strict";
import { serve } from "./server.mjs";

const wide = { viewport: { width: 1120, height: 420 } };
const until = (page, condition, argument = null) => page.waitForFunction(condition, argument, { polling: 50 });
const there = (page, count) => until(page, (count) => window.lendulet.sources.engine.threads.there === count, count);
const setThreads = async (page, count) => {
    await page.fill("#set-threads", `${count}`);
    await page.press("#set-threads", "Enter");
    assert.equal(await page.evaluate(() => window.lendulet.player.world.settings().workers), count);
};
const steps = (page, count) => page.evaluate((count) => {
    const { player } = window.lendulet;
    for (let i = 0; i < count; ++i) player.step();
    return player.world.hash;
}, count);
const openScene = (page, scene) => page.evaluate((scene) => {
    window.lendulet.open(scene);
    window.lendulet.player.playing = false;
}, scene);
const dominoes = ({ hashes }) => Object.keys(hashes).find((name) => name.startsWith("domino_spiral"));
// The module that a page has loaded.
const module = (page) => page.evaluate(() => performance.getEntriesByType("resource")
    .map(({ name }) => name.split("/").pop()).filter((name) => /^lendulet.*wasm$/.test(name)).join());
const address = "?shadows=0&threads=2";

export const threadChecks = {
    async "threads: native bits with one, two and four, also from the past on and in forks"({ open, native }) {
        const page = await open(wide, `${address}#scene=stack:3&paused=1`);
        assert.ok(await page.evaluate(() => crossOriginIsolated), "not isolated");
        assert.equal(await module(page), "lendulet_threads.wasm");
        await there(page, 2);
        const scene = dominoes(native);
        for (const count of [2, 4, 1]) {
            await openScene(page, scene);
            await setThreads(page, count);
            assert.equal(await steps(page, native.steps), native.hashes[scene], `${count} threads`);
        }
        await there(page, 4); // those who are not wanted sleep
        await page.fill("#set-threads", "65"); // refused, in words that are the page's thread's own
        await page.press("#set-threads", "Enter");
        await until(page, () => document.getElementById("message").textContent.includes("1 to 64"));
        // Rewinding, with another number of threads in the past, and a fork beside the world.
        await openScene(page, scene);
        assert.equal(await page.evaluate(() => window.lendulet.player.world.settings().workers), 2);
        await steps(page, 60);
        await setThreads(page, 3);
        await steps(page, 30);
        const step = await page.evaluate(() => {
            const { player } = window.lendulet;
            player.look(8);
            player.fork();
            return player.world.stepCount;
        });
        assert.ok(step > 0 && step < 60, `${step}`);
        await setThreads(page, 4);
        assert.equal(await steps(page, native.steps - step), native.hashes[scene]);
        assert.equal(await page.evaluate(() => window.lendulet.player.twin.hash), native.hashes[scene]);
        await page.evaluate(() => {
            window.lendulet.lastFigures = -1e9;
            window.lendulet.frame();
        });
        assert.match(await page.textContent("#numbers"), /by 4 threads/);
    },

    async "threads: worlds come and go, and all their broad phases, with the threads that there are"({ open }) {
        const page = await open(wide, `${address}#scene=box_pile:60&compare=1&paused=1`);
        await there(page, 2);
        const rows = await page.evaluate(() => {
            const { player, comparison, sources } = window.lendulet;
            for (let i = 0; i < 60; ++i) player.step();
            for (let i = 0; i < 30; ++i) {
                const world = sources.engine.create(`stack:${i + 1}`);
                world.run(3);
                world.destroy();
            }
            return comparison.rows();
        });
        assert.ok(rows.length === 8 && rows.every(({ same }) => same), JSON.stringify(rows));
        assert.equal(await page.evaluate(() => window.lendulet.sources.engine.threads.there), 2);
    },

    async "threads: memory that grows while they work is seen by the page"({ open }) {
        const page = await open({}, `${address}#scene=stack:3&paused=1`);
        await there(page, 2);
        const [before, after, finite] = await page.evaluate(() => {
            const { engine } = window.lendulet.sources, before = engine.buffer.byteLength, worlds = [];
            for (let i = 0; i < 4; ++i) worlds.push(engine.create("box_pile:1500"));
            for (const world of worlds) world.run(20);
            const finite = worlds.every((world) => world.poses().every(Number.isFinite) && world.contacts().length > 0);
            return [before, engine.buffer.byteLength, finite];
        });
        assert.ok(after > before && finite, `${before} to ${after} bytes`);
    },

    async "threads: without isolation, workers or the module the page has one"({ open, native, folder, forgive }) {
        const scene = dominoes(native);
        const server = await serve(folder, false);
        try {
            const page = await open(wide, `${address}#scene=stack:3&paused=1`, server.url);
            assert.equal(await page.evaluate(() => crossOriginIsolated), false);
            assert.equal(await module(page), "lendulet.wasm");
            assert.ok(await page.isDisabled("#set-threads"));
            await openScene(page, scene);
            assert.equal(await steps(page, native.steps), native.hashes[scene]);
            await page.context().close(); // before its server
        } finally {
            server.close();
        }
        forgive(/404/);
        for (const missing of ["worker.js", "lendulet_threads.wasm"]) {
            const page = await open({ ...wide, missing }, `${address}#scene=stack:3&paused=1`);
            if (missing === "worker.js") {
                await until(page, () => document.getElementById("message").textContent.includes("goes on with 1"));
                assert.equal(await page.evaluate(() => window.lendulet.sources.engine.threads.there), 1);
            } else {
                assert.equal(await page.evaluate(() => window.lendulet.sources.engine.threads), null);
            }
            await openScene(page, scene);
            assert.equal(await steps(page, native.steps), native.hashes[scene], missing);
        }
    },
};
