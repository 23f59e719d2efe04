// Checks of the tools beside the scene: plots, the broad phases compared, what happened beside what may, shapes that
// are dropped, what the address says, and how the page fits and is painted.
import assert from "node:assert/strict";

const wide = { viewport: { width: 1120, height: 420 } }; // both panels are seen
const until = (page, condition, argument = null) => page.waitForFunction(condition, argument, { polling: 50 });
const steps = (page, count) => page.evaluate((count) => {
    for (let i = 0; i < count; ++i) window.lendulet.player.step();
    const { world } = window.lendulet.player;
    return { hash: world.hash, step: world.stepCount };
}, count);
// Draws a frame and brings the panels up to date at once.
const look = (page) => page.evaluate(() => {
    window.lendulet.lastFigures = -1e9;
    window.lendulet.frame();
});

export const toolChecks = {
    async "tools: all broad phases go along with the world, with the same bits"({ open }) {
        const page = await open(wide, "?shadows=0#scene=box_pile:60&compare=1&paused=1");
        await steps(page, 60);
        await page.evaluate(() => window.lendulet.hand.shoot(500, 200)); // into all of them
        await steps(page, 30);
        await page.evaluate(() => window.lendulet.player.look(4)); // and back in time with all of them
        await steps(page, 40);
        const rows = await page.evaluate(() => window.lendulet.comparison.rows());
        assert.equal(rows.length, 8);
        assert.ok(rows.every((r) => r.same), JSON.stringify(rows));
        assert.ok(rows.some((r) => r.time > 0), JSON.stringify(rows));
        await look(page);
        assert.equal(await page.locator("#compare-rows .row").count(), 8);
        assert.match(await page.textContent("#compare-same"), /pairs of boxes .* same bits/);
        await page.click("#compare-close");
        assert.ok(!(await page.isVisible("#compare")));
        assert.ok(!(await page.evaluate(() => location.hash)).includes("compare"));
        await page.keyboard.press("p");
        assert.ok(await page.isVisible("#compare"));
    },

    async "tools: plots of the world, a body and a joint"({ open }) {
        const page = await open(wide, "?shadows=0#scene=ragdolls:2&paused=1");
        const plot = (name) => page.evaluate((name) => {
            const app = window.lendulet, what = document.getElementById("plot-what");
            what.value = name;
            what.dispatchEvent(new Event("change"));
            for (let i = 0; i < 3; ++i) {
                app.player.step();
                app.lastFigures = -1e9;
                app.frame();
            }
            return app.inspector.plot.samples.at(-1)?.value;
        }, name);
        await steps(page, 100);
        assert.equal(await page.textContent("#subject"), "World");
        assert.ok(await plot("total energy") > 0 && await plot("momentum") > 0 && await plot("contact impulse") > 0);
        // A body of a ragdoll, and its first joint.
        await page.evaluate(() => window.lendulet.pick(window.lendulet.player.world.joints()[0].bodyB));
        assert.equal(await page.textContent("#subject"), "Body");
        for (const name of ["kinetic energy", "momentum", "angular momentum", "speed"])
            assert.ok(await plot(name) > 0, name);
        await look(page);
        await page.click("#body-joints .line");
        assert.equal(await page.textContent("#subject"), "Joint");
        assert.ok(await plot("force") > 0);
        assert.match(await page.textContent("#plot-now"), / N$/);
        const marks = await page.evaluate(() => {
            const { canvas } = window.lendulet.inspector.plot, pen = canvas.getContext("2d");
            return pen.getImageData(0, 0, canvas.width, canvas.height).data.filter((v) => v > 0).length;
        });
        assert.ok(marks > 100, `${marks} bytes of a line`);
        await page.keyboard.press("Escape");
        assert.equal(await page.textContent("#subject"), "World");
    },

    async "tools: what happened stands beside what may, twice"({ open }) {
        const page = await open(wide, "?shadows=0#scene=large_pyramid:6&paused=1");
        await steps(page, 20);
        await page.evaluate(() => window.lendulet.hand.shoot(...window.lendulet.middle));
        const first = await steps(page, 60);
        for (let round = 0; round < 2; ++round) {
            const now = await page.evaluate(() => {
                const { player, hand, middle } = window.lendulet;
                player.look(2); // step 10, before the shot
                player.fork();
                hand.drop(...middle);
                for (let i = 0; i < 70; ++i) player.step();
                const bodies = player.twinNow.length - player.now.length;
                return { own: player.world.hash, other: player.twin.hash, bodies };
            });
            if (round === 0) assert.equal(now.other, first.hash, "what happened is not what happens");
            assert.notEqual(now.own, now.other);
            assert.equal(now.bodies, 0, "a ball in one, a box in the other");
        }
        await look(page);
        await page.keyboard.press("k");
        assert.equal(await page.evaluate(() => window.lendulet.player.twin), null);
        // From the very beginning.
        const again = await page.evaluate(() => {
            const { player } = window.lendulet;
            player.look(0);
            for (let i = 0; i < 80; ++i) player.step();
            return { step: player.world.stepCount, deeds: player.deeds.length };
        });
        assert.deepEqual(again, { step: 80, deeds: 0 });
    },

    async "tools: every shape falls and lies"({ open }) {
        const page = await open(wide, "?shadows=0#scene=two_boxes&paused=1");
        await page.evaluate(() => window.lendulet.open("stack:1"));
        const names = await page.locator("#shape option").allTextContents();
        assert.ok(names.length >= 6);
        for (const name of names) {
            await page.selectOption("#shape", name);
            await page.click("#drop");
        }
        await steps(page, 120);
        const bodies = await page.evaluate(() => window.lendulet.player.now.length / 8);
        assert.equal(bodies, 2 + names.length);
        const low = await page.evaluate(() =>
            window.lendulet.player.now.filter((_, i) => i % 8 === 1).slice(1).every((y) => y > -0.1 && y < 40));
        assert.ok(low, "something fell through");
    },

    async "tools: the address keeps what is drawn; what cannot be done is left out"({ open }) {
        const page = await open(wide, "?shadows=0#scene=ragdolls:2&draw=levels,manifolds,centres&paused=1");
        await steps(page, 60);
        assert.ok(await page.isChecked("#show-manifolds") && await page.isChecked("#show-centres"));
        assert.equal(await page.inputValue("#boxes"), "levels");
        await look(page);
        const drawn = await page.evaluate(() => window.lendulet.picture.structure.group.children
            .map((mesh) => (mesh.visible ? mesh.geometry.drawRange.count : 0)));
        assert.ok(drawn[4] > 4 && drawn[5] >= 6 * 20, drawn.join());
        await page.uncheck("#show-centres");
        await until(page, () => location.hash.includes("draw=levels,manifolds&"));
        const text = (deeds) => Buffer.from(JSON.stringify(deeds)).toString("base64url");
        const bad = [[[0, { do: "explode" }]], [[0, { do: "sphere" }]], [[-1, { do: "release" }]], "x", [7],
            [[0, { do: "set", gravity: 3 }]], [[5, { do: "release" }], [2, { do: "release" }]]];
        for (const [i, deeds] of bad.entries()) {
            await page.evaluate((hash) => (location.hash = hash),
                `#scene=stack:${i + 1}&paused=1&deeds=${text(deeds)}&view=1,2&draw=nothing`);
            await until(page, (name) => window.lendulet.player.sceneName === name, `stack:${i + 1}`);
            await steps(page, 3);
            assert.equal(await page.evaluate(() => window.lendulet.player.deeds.length), 0, JSON.stringify(deeds));
        }
        // A deed that the engine refuses is said, and the page goes on.
        await page.evaluate((deeds) => (location.hash = `#scene=stack:9&deeds=${deeds}`),
            text([[3, { do: "sphere", radius: -1, at: [0, 5, 0], velocity: [0, 0, 0], density: 1 }]]));
        await until(page, () => window.lendulet.player.sceneName === "stack:9");
        // It goes by itself, which a slow machine may miss.
        await page.evaluate(() => new MutationObserver(() => (window.wasSaid = true))
            .observe(document.getElementById("message"), { childList: true, characterData: true, subtree: true }));
        await page.click("#play");
        await until(page, () => window.wasSaid === true);
        await page.click("#play");
        await until(page, () => window.lendulet.player.world.stepCount > 10);
    },

    async "tools: nothing is cut off, from 320 pixels on, and the first paint is within a second"({ open }) {
        const sizes = [[320, 568], [360, 700], [568, 320], [768, 1024], [900, 560], [1024, 600], [1280, 720]];
        const page = await open({ viewport: { width: 320, height: 568 } }, "?shadows=0#scene=stack:3&paused=1");
        for (const [width, height] of sizes) {
            await page.setViewportSize({ width, height });
            await page.evaluate(() => window.lendulet.frame());
            const cut = await page.evaluate(() => {
                const list = [...document.querySelectorAll("#transport :is(button, select, input), #corner button")]
                    .filter((e) => e.checkVisibility());
                const out = list.filter((e) => {
                    const { left, top, right, bottom } = e.getBoundingClientRect();
                    return left < 0 || top < 0 || right > innerWidth + 0.5 || bottom > innerHeight + 0.5;
                });
                const canvas = document.getElementById("canvas").getBoundingClientRect();
                return { ids: out.map((e) => e.id), wide: document.documentElement.scrollWidth - innerWidth,
                    seen: canvas.height };
            });
            assert.deepEqual(cut.ids, [], `${width} × ${height}`);
            assert.ok(cut.wide <= 0 && cut.seen > 100, `${width} × ${height}: ${JSON.stringify(cut)}`);
        }
        // The best of three: this machine may be busy.
        const paints = [];
        while (paints.length < 3 && !(Math.min(...paints) < 1000)) {
            const other = await open({}, "?shadows=0#scene=stack:3&paused=1");
            paints.push(await other.evaluate(() =>
                performance.getEntriesByName("first-contentful-paint")[0]?.startTime ?? Infinity));
            await other.context().close();
        }
        assert.ok(Math.min(...paints) < 1000, `first paint after ${paints} ms`);
    },

    async "tools: the nodes that WebGPU draws with show the scene too"({ open, look: colours }) {
        const page = await open({ viewport: { width: 480, height: 320 } },
            "?draw=nodes&shadows=512#scene=hourglass:100&paused=1");
        await steps(page, 30);
        await page.evaluate(() => window.lendulet.toggleTheme());
        await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
        const png = await page.screenshot({ clip: await page.locator("main").boundingBox() });
        const { colours: many, commonest } = await colours(page, png);
        assert.ok(many > 500 && commonest < 0.9, `${many} colours, ${commonest} of one`);
    },
};
