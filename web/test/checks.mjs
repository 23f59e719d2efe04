// What the page must do. Each check opens pages of its own and throws where something is wrong.
import assert from "node:assert/strict";

const stride = 8;

// In the page: pauses, opens a scene, steps it.
async function run(page, scene, steps) {
    return page.evaluate(([scene, steps]) => {
        const { player } = window.lendulet;
        player.playing = false;
        if (!window.lendulet.open(scene)) throw new Error(`${scene} does not open`);
        player.playing = false;
        const first = player.now.slice();
        for (let i = 0; i < steps; ++i) player.step();
        const { hash, stepCount: step } = player.world;
        return { hash, step, first: Array.from(first), now: Array.from(player.now) };
    }, [scene, steps]);
}
const state = (page) => page.evaluate(() => {
    const { player } = window.lendulet;
    const { hash, stepCount: step } = player.world;
    return { hash, step, bodies: player.now.length / 8, playing: player.playing };
});
// By the clock and not by frames, which may be rare.
const until = (page, condition) => page.waitForFunction(condition, null, { polling: 100 });
const frames = (page, count) => page.evaluate((count) => new Promise((done) => {
    const next = () => (count-- > 0 ? requestAnimationFrame(next) : done());
    next();
}), count);

// How many colours, and how much of the commonest one, a picture has.
export async function look(page, png) {
    return page.evaluate(async (base64) => {
        const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
        const pen = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
        pen.drawImage(bitmap, 0, 0);
        const pixels = new Uint32Array(pen.getImageData(0, 0, bitmap.width, bitmap.height).data.buffer);
        const counts = new Map();
        for (const p of pixels) counts.set(p, (counts.get(p) ?? 0) + 1);
        return { colours: counts.size, commonest: Math.max(...counts.values()) / pixels.length };
    }, png.toString("base64"));
}

export const checks = {
    async "every scene moves, stays finite and has the native hash after 120 steps"({ open, native, scenes }) {
        const page = await open({ viewport: { width: 320, height: 200 } });
        assert.ok(Object.keys(native.hashes).length >= scenes);
        for (const [scene, hash] of Object.entries(native.hashes)) {
            const result = await run(page, scene, native.steps);
            assert.equal(result.step, native.steps, scene);
            assert.ok(result.now.every(Number.isFinite), `${scene}: a pose is not finite`);
            assert.ok(result.now.some((v, i) => v !== result.first[i]), `${scene}: nothing moves`);
            assert.equal(result.hash, hash, `${scene}: hash`);
        }
        await page.evaluate(() => window.lendulet.player.play(false));
        await run(page, "stack:20", native.steps);
        await until(page, () => document.getElementById("same").textContent === "same bits as native");
    },

    async "play, pause, step and restart by buttons and keys"({ open }) {
        const page = await open({}, "?shadows=0#scene=stack:5&paused=1");
        assert.equal((await state(page)).step, 0);
        await page.click("#step");
        assert.equal((await state(page)).step, 1);
        await page.keyboard.press("ArrowRight");
        assert.equal((await state(page)).step, 2);
        await page.click("#play");
        await until(page, () => window.lendulet.player.world.stepCount > 20);
        await page.focus("#canvas");
        await page.keyboard.press("Space");
        const paused = await state(page);
        assert.equal(paused.playing, false);
        await frames(page, 5);
        assert.equal((await state(page)).step, paused.step);
        await page.click("#restart");
        assert.equal((await state(page)).step, 0);
        await page.keyboard.press("?");
        assert.ok(await page.isVisible("#keys"));
        await page.keyboard.press("Escape");
        assert.ok(!(await page.isVisible("#keys")));
    },

    async "picking, pulling and throwing with the pointer"({ open }) {
        const page = await open({}, "?shadows=0#scene=stack:3&paused=1");
        await frames(page, 3);
        const at = await page.evaluate(() => {
            const app = window.lendulet, n = app.player.now.length / 8 - 1;
            return { top: app.stage.project(app.player.position(n)), n };
        });
        await page.mouse.click(...at.top);
        await until(page, () => !document.getElementById("picked").hidden);
        const picked = await page.evaluate(() => window.lendulet.inspector.body);
        assert.equal(picked, at.n);
        // Up and sideways, three steps for each move of the pointer, and let go in motion.
        await page.mouse.move(...at.top);
        await page.mouse.down();
        for (let i = 1; i <= 12; ++i) {
            await page.mouse.move(at.top[0] + 9 * i, at.top[1] - 4 * i);
            await page.evaluate(() => {
                for (let k = 0; k < 3; ++k) window.lendulet.player.step();
            });
        }
        const held = await page.evaluate(() => window.lendulet.player.world.grabbed());
        assert.ok(held, "nothing is held");
        await page.mouse.up();
        const flight = await page.evaluate(() => {
            const { player, inspector } = window.lendulet;
            return { v: player.world.body(inspector.body).velocity, held: player.world.grabbed() };
        });
        assert.equal(flight.held, null);
        assert.ok(Math.hypot(...flight.v) > 0.5, `thrown with ${flight.v} m/s`);
        await page.keyboard.press("Escape");
        assert.equal(await page.evaluate(() => window.lendulet.inspector.body), null);
    },

    async "balls, boxes, rewinding and branching"({ open }) {
        const page = await open({}, "?shadows=0#scene=large_pyramid:6&paused=1");
        const base = await run(page, "large_pyramid:6", 60);
        const count = base.now.length / stride;
        await page.click("#shoot");
        await page.click("#drop");
        assert.equal((await state(page)).bodies, count + 2);
        await page.evaluate(() => {
            for (let i = 0; i < 60; ++i) window.lendulet.player.step();
        });
        const struck = await state(page);
        assert.equal(struck.step, 120);
        // Back to before the shot: the picture is of then, the run goes on from there without the ball.
        await frames(page, 2);
        await page.evaluate(() => window.lendulet.player.look(6)); // moments are five steps apart
        assert.equal(await page.evaluate(() => window.lendulet.player.moment.step), 30);
        assert.equal((await state(page)).step, 120, "looking changes nothing");
        await page.evaluate(() => {
            for (let i = 0; i < 30; ++i) window.lendulet.player.step();
        });
        const again = await state(page);
        assert.equal(again.bodies, count);
        assert.equal(again.step, 60);
        assert.equal(again.hash, base.hash, "the run after rewinding is the run before");
    },

    async "the address keeps scene, colours and contacts; wrong names are said"({ open }) {
        const page = await open({}, "?shadows=0#scene=dominoes:12&colours=speed&contacts=1&paused=1");
        assert.equal(await page.evaluate(() => window.lendulet.player.sceneName), "dominoes:12");
        assert.equal(await page.inputValue("#colours"), "speed");
        assert.equal(await page.getAttribute("#contacts", "aria-pressed"), "true");
        await page.fill("#size", "20");
        await page.press("#size", "Enter");
        await until(page, () => location.hash.includes("scene=dominoes:20"));
        await page.evaluate(() => (location.hash = "#scene=dominos"));
        await until(page, () => document.getElementById("message").textContent.includes("dominoes"));
        assert.equal(await page.evaluate(() => window.lendulet.player.sceneName), "dominoes:20");
    },

    async "a phone shows the scene without horizontal scroll, panels as sheets"({ open }) {
        const page = await open({ viewport: { width: 360, height: 700 }, hasTouch: true, isMobile: true },
            "?shadows=0#scene=newtons_cradle:5");
        const wide = await page.evaluate(() => ({ page: document.documentElement.scrollWidth, window: innerWidth }));
        assert.ok(wide.page <= wide.window, `${wide.page} pixels in ${wide.window}`);
        await page.tap("#open-scenes");
        await page.tap("#list a[href*=two_boxes]");
        assert.equal(await page.evaluate(() => window.lendulet.player.sceneName), "two_boxes");
        await until(page, () => document.getElementById("scenes").getBoundingClientRect().right <= 0);
        for (const id of ["play", "step", "restart", "shoot", "contacts", "help"]) {
            const box = await page.locator(`#${id}`).boundingBox();
            assert.ok(box.x >= 0 && box.x + box.width <= 360 && box.y + box.height <= 700, `${id} is cut off`);
        }
    },

    async "every control has a name"({ open }) {
        const page = await open({}, "?shadows=0#scene=two_boxes&paused=1");
        const nameless = await page.evaluate(() =>
            [...document.querySelectorAll("button, input, select, canvas, a, aside, dialog")]
                .filter((e) => !e.getAttribute("aria-label") && !e.getAttribute("aria-labelledby"))
                .filter((e) => !e.textContent.trim() && !e.labels?.length)
                .map((e) => e.outerHTML));
        assert.deepEqual(nameless, []);
    },

    async "pictures of scenes show something"({ open, save, keeps }) {
        const pictures = [
            ["domino_spiral:300", 700, "body", "light"], ["brick_tower:20", 190, "body", "light"],
            ["hourglass:800", 330, "body", "light"], ["bridge:26", 330, "body", "light"],
            ["gear_train:5", 120, "body", "light"], ["walker", 200, "body", "light", "fit"],
            ["ragdoll_avalanche:60", 170, "body", "light"], ["marble_machine:40", 480, "body", "dark"],
            ["mixed_pile:600", 300, "body", "light"], ["ragdolls:24", 150, "body", "light"],
            ["wall_ball:14", 75, "body", "light"], ["mesh_terrain:400", 200, "body", "light"],
            ["joint_grid:24", 110, "body", "light"], ["tumbler:9", 240, "speed", "dark"],
        ];
        for (const [scene, steps, colours, scheme, fit] of pictures) {
            const page = await open({ viewport: { width: 680, height: 460 }, colorScheme: scheme },
                `?shadows=1024${keeps ? "" : "&ao=0"}#scene=${scene}&colours=${colours}&paused=1`);
            await run(page, scene, steps);
            if (fit) await page.evaluate(() => window.lendulet.picture.lookAtAll());
            await frames(page, 1);
            const png = await page.screenshot({ clip: await page.locator("main").boundingBox() });
            const { colours: many, commonest } = await look(page, png);
            assert.ok(many > 500 && commonest < 0.9, `${scene}: ${many} colours, ${commonest} of one`);
            save(`viewer-${scene.split(":")[0]}.png`, png);
            await page.context().close();
        }
    },

    async "pictures of the engine's structures and of two futures show something"({ open, save, keeps }) {
        const show = async (name, scene, steps, prepare, more) => {
            const looks = `?shadows=1024${keeps ? "" : "&ao=0"}`;
            const page = await open({ viewport: { width: 680, height: 460 } }, `${looks}#scene=${scene}&paused=1`);
            await run(page, scene, steps);
            await page.evaluate(prepare);
            await page.evaluate((count) => {
                for (let i = 0; i < count; ++i) window.lendulet.player.step();
            }, more);
            await frames(page, 2);
            const png = await page.screenshot({ clip: await page.locator("main").boundingBox() });
            const { colours: many, commonest } = await look(page, png);
            assert.ok(many > 500 && commonest < 0.9, `${name}: ${many} colours, ${commonest} of one`);
            save(`viewer-${name}.png`, png);
            await page.context().close();
        };
        await show("levels", "box_pile:200", 150, () => {
            window.lendulet.change({ do: "set", broadPhase: 6 });
            window.lendulet.setDrawn(["levels"]);
        }, 1);
        await show("futures", "large_pyramid:12", 30, () => {
            const app = window.lendulet;
            app.player.fork();
            app.hand.shoot(...app.stage.project([0, 4, 0]));
            document.getElementById("message").hidden = true;
        }, 70);
        await show("phases", "box_pile:200", 60, () => window.lendulet.compare(true), 60);
        await show("manifolds", "large_pyramid:4", 20, () => {
            window.lendulet.setDrawn(["manifolds", "centres"]);
            window.lendulet.setContacts(true);
        }, 20);
        await show("joints", "ragdolls:6", 60, () => window.lendulet.setDrawn(["joints"]), 1);
    },
};
