// Checks of the native stream: `lendulet view` and the page that it serves.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { request } from "node:http";
import { connect } from "node:net";
import { randomBytes } from "node:crypto";
import { tmpdir } from "node:os";
import { join } from "node:path";

// Starts the program; resolves to { url, port, end, output, ended } once it says where it listens.
export function startNative(program, folder, scene, ...options) {
    const child = spawn(program, ["view", scene, "--port", "0", "--page", folder, ...options]);
    let output = "";
    child.stderr.on("data", (text) => (output += text));
    const ended = new Promise((done) => child.on("exit", (code) => done(code)));
    return new Promise((done, fail) => {
        child.stdout.on("data", (text) => {
            output += text;
            const found = /http:\/\/localhost:(\d+)\//.exec(output);
            if (found) done({
                url: found[0], port: Number(found[1]), ended, output: () => output,
                end: () => (child.kill("SIGINT"), ended),
                kill: () => child.kill("SIGKILL"),
            });
        });
        child.on("exit", () => fail(new Error(`lendulet view ended: ${output}`)));
        setTimeout(() => fail(new Error(`lendulet view says nothing: ${output}`)), 20000).unref();
    });
}

// The status with which an upgrade is answered; with 101, its socket.
function upgrade(port, headers) {
    return new Promise((done, fail) => {
        const asked = request({
            port, host: "127.0.0.1", path: "/stream",
            headers: {
                Host: `localhost:${port}`, Connection: "Upgrade", Upgrade: "websocket", "Sec-WebSocket-Version": "13",
                "Sec-WebSocket-Key": randomBytes(16).toString("base64"), ...headers,
            },
        });
        asked.on("upgrade", (answer, socket) => done({ status: answer.statusCode, socket }));
        asked.on("response", (answer) => (answer.resume(), done({ status: answer.statusCode })));
        asked.on("error", fail);
        asked.end();
    });
}
const closed = (socket) => new Promise((done) => {
    socket.on("close", done);
    socket.on("error", done);
    socket.resume();
});
// A message of a client, masked as the protocol wants it.
function frame(text) {
    const body = Buffer.from(text), mask = randomBytes(4);
    const size = Buffer.alloc(8);
    size.writeBigUInt64BE(BigInt(body.length));
    const head = body.length < 126 ? Buffer.from([0x81, 0x80 | body.length])
        : body.length < 65536 ? Buffer.from([0x81, 0xfe, ...size.subarray(6)]) : Buffer.from([0x81, 0xff, ...size]);
    return Buffer.concat([head, mask, body.map((byte, i) => byte ^ mask[i & 3])]);
}
const get = (port, path, headers = {}) => new Promise((done, fail) => {
    request({ port, host: "127.0.0.1", path, headers: { Host: `localhost:${port}`, ...headers } }, (answer) => {
        answer.resume();
        done(answer.statusCode);
    }).on("error", fail).end();
});

const until = (page, condition, argument = null) => page.waitForFunction(condition, argument, { polling: 50 });

export const nativeChecks = {
    async "native: the page shows a native world, and what is done by hand acts in it"({ open, program, folder }) {
        const native = await startNative(program, folder, "large_pyramid:6");
        const page = await open({ viewport: { width: 1120, height: 420 } }, "?shadows=0#paused=1", native.url);
        await until(page, () => window.lendulet.player.world?.kind === "native");
        // Isolated, so that the page's own engine could have threads; it has none while the native one computes.
        assert.ok(await page.evaluate(() => crossOriginIsolated), "not isolated");
        assert.equal(await page.evaluate(() => window.lendulet.sources.engine.threads), null);
        const base = await page.evaluate(() => window.lendulet.player.now.length / 8);
        assert.equal(base, 22);
        // The same bits as in the page.
        const step = async (count) => {
            const from = await page.evaluate(() => window.lendulet.player.world.stepCount);
            for (let i = 1; i <= count; ++i) {
                await page.evaluate(() => window.lendulet.player.step());
                await until(page, (wanted) => window.lendulet.player.world.stepCount === wanted, from + i);
            }
        };
        await step(30);
        await until(page, () => window.lendulet.player.world.hash !== "");
        const hashes = await page.evaluate(() => {
            const { player, sources } = window.lendulet, other = sources.engine.create("large_pyramid:6");
            other.run(30);
            return [player.world.hash, other.hash];
        });
        assert.equal(hashes[0], hashes[1]);
        await page.click("#shoot");
        await until(page, () => window.lendulet.player.now.length / 8 === 23);
        await step(20);
        await until(page, () => window.lendulet.player.history.moments.length > 8);
        await page.evaluate(() => {
            window.lendulet.player.look(4);
            window.lendulet.player.step();
        });
        await until(page, () => window.lendulet.player.now.length / 8 === 22);
        await until(page, () => window.lendulet.player.world.stepCount === 21);
        // Settings, picking and playing.
        await page.fill("#set-substeps", "3");
        await page.press("#set-substeps", "Enter");
        await until(page, () => window.lendulet.player.world.settings()?.solverSteps === 3);
        await page.fill("#set-threads", "2");
        await page.press("#set-threads", "Enter");
        await until(page, () => window.lendulet.player.world.settings()?.workers === 2);
        const at = await page.evaluate(() => window.lendulet.stage.project(window.lendulet.player.position(21)));
        await page.mouse.click(...at);
        await until(page, () => document.getElementById("body-numbers").textContent.includes("kg"));
        await page.click("#play");
        await until(page, () => window.lendulet.player.world.stepCount > 60);
        await page.click("#fork");
        await until(page, () => (window.lendulet.player.twin?.stepCount ?? 0) > 70);
        await page.context().close();
        assert.equal(await native.end(), 0);
    },

    async "native: what a glTF file shows is drawn, with pictures beside it, and no other file is served"({
        open, program, folder,
    }) {
        const place = mkdtempSync(join(tmpdir(), "lendulet-"));
        try {
            // A crate and the ground, both with a picture, and a child that is only seen.
            const positions = Float32Array.of(-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1);
            const corners = Float32Array.of(0, 0, 1, 0, 1, 1, 0, 1), triangles = Uint16Array.of(0, 2, 1, 0, 3, 2);
            const data = Buffer.concat([positions, corners, triangles].map((list) => Buffer.from(list.buffer)));
            writeFileSync(join(place, "scene data.bin"), data);
            const dot = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJg"
                + "gg==";
            mkdirSync(join(place, "textures"));
            writeFileSync(join(place, "textures", "dot.png"), Buffer.from(dot, "base64"));
            writeFileSync(join(place, "secret.png"), "no");
            const collider = { geometry: { shape: 0 } };
            const body = (motion) => ({ KHR_physics_rigid_bodies: { ...motion, collider } });
            writeFileSync(join(place, "crate.gltf"), JSON.stringify({
                asset: { version: "2.0" }, scene: 0, scenes: [{ nodes: [0, 1] }],
                extensionsUsed: ["KHR_physics_rigid_bodies", "KHR_implicit_shapes"],
                extensions: { KHR_implicit_shapes: { shapes: [{ type: "box", box: { size: [1, 1, 1] } }] } },
                nodes: [
                    { name: "ground", mesh: 0, extensions: body({}) },
                    { name: "crate", translation: [0, 3, 0], children: [2], extensions: body({ motion: { mass: 2 } }) },
                    { name: "lid", mesh: 0, translation: [0, 0.5, 0] },
                ],
                meshes: [{ primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, indices: 2, material: 0 }] }],
                materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }],
                textures: [{ source: 0 }], images: [{ uri: "textures/dot.png" }],
                accessors: [
                    { bufferView: 0, componentType: 5126, count: 4, type: "VEC3", min: [-1, 0, -1], max: [1, 0, 1] },
                    { bufferView: 1, componentType: 5126, count: 4, type: "VEC2" },
                    { bufferView: 2, componentType: 5123, count: 6, type: "SCALAR" },
                ],
                bufferViews: [[0, 48], [48, 32], [80, 12]].map(([byteOffset, byteLength]) =>
                    ({ buffer: 0, byteOffset, byteLength })),
                buffers: [{ byteLength: data.length, uri: "scene data.bin" }],
            }));
            const native = await startNative(program, folder, join(place, "crate.gltf"));
            const page = await open({}, "?shadows=0#paused=1", native.url);
            await until(page, () => window.lendulet?.picture.visuals);
            const drawn = await page.evaluate(() => {
                const { visuals, bodies } = window.lendulet.picture, pictures = [];
                visuals.group.traverse(({ material }) => material && pictures.push(material.map?.image.width));
                window.lendulet.frame();
                return { parts: [...visuals.parts.keys()], hidden: [...bodies.hidden.keys()], pictures };
            });
            assert.deepEqual(drawn, { parts: [0, 1], hidden: [0, 1], pictures: [1, 1] });
            for (const path of ["/gltf", "/gltf/scene%20data.bin", "/gltf/textures/dot.png"])
                assert.equal(await get(native.port, path), 200, path);
            for (const path of ["/gltf/secret.png", "/gltf/textures/../secret.png", "/gltf/", "/secret.png"])
                assert.equal(await get(native.port, path), 404, path);
            await page.context().close();
            assert.equal(await native.end(), 0);
        } finally {
            rmSync(place, { recursive: true });
        }
    },

    async "native: a repro file is made again, broad phases go along, and without the engine the page goes on"({
        open, program, folder, forgive,
    }) {
        const place = mkdtempSync(join(tmpdir(), "lendulet-"));
        try {
            const file = join(place, "thrown.json"), hash = "0000000000000000";
            const ball = { do: "sphere", radius: 0.4, at: [-6, 2, 0], velocity: [14, 0, 0], density: 800 };
            const repro = { lendulet: "repro", version: 1, scene: "stack:4", steps: 50, hash,
                deeds: [{ step: 7, command: ball }] };
            writeFileSync(file, JSON.stringify(repro));
            const summary = spawnSync(program, ["run", file, "--json", "-", "--quiet"], { encoding: "utf8" });
            assert.equal(summary.status, 1); // not those bits
            writeFileSync(file, JSON.stringify({ ...repro, hash: JSON.parse(summary.stdout).hash }));
            const native = await startNative(program, folder, file);
            const page = await open({ viewport: { width: 1120, height: 420 } }, "?shadows=0", native.url);
            await until(page, () => document.getElementById("message").textContent.startsWith("The same bits"));
            assert.equal(await page.evaluate(() => window.lendulet.player.world.kind), "native");
            await page.keyboard.press("p");
            const from = await page.evaluate(() => window.lendulet.player.world.stepCount);
            await until(page, (from) => window.lendulet.player.world.stepCount > from + 40, from);
            await page.click("#drop");
            await page.evaluate(() => (window.lendulet.player.playing = false));
            await until(page, () => !window.lendulet.player.world.busy);
            await page.evaluate(() => window.lendulet.player.step());
            await until(page, () => window.lendulet.comparison.rows().every((r) => r.same && r.time > 0));
            // The engine dies while the page plays.
            await page.click("#play");
            forgive(/ERR_CONNECTION_REFUSED/); // such as for the page's icon, when its address changes
            native.kill();
            await until(page, () => document.getElementById("message").textContent.includes("gone"));
            await page.click("#step");
            await page.keyboard.press("r");
            await until(page, () => window.lendulet.player.world.kind === "page");
            await page.evaluate(() => window.lendulet.player.play(true));
            await until(page, () => window.lendulet.player.world.stepCount > 5);
            await page.context().close();
        } finally {
            rmSync(place, { recursive: true });
        }
    },

    async "native: foreign pages and names are refused, and only the page's files are served"({ program, folder }) {
        const { port, end } = await startNative(program, folder, "stack:3");
        const own = { Origin: `http://localhost:${port}` };
        const foreign = ["http://example.org", "null", `https://localhost:${port}`, `http://localhost:${port + 1}`,
            `http://localhost:${port}.example.org`].map((Origin) => ({ Origin }));
        for (const headers of [{}, ...foreign, { ...own, Host: `example.org:${port}` }])
            assert.equal((await upgrade(port, headers)).status, 403, JSON.stringify(headers));
        const { status, socket } = await upgrade(port, own);
        assert.equal(status, 101);
        socket.destroy();
        assert.equal(await get(port, "/"), 200);
        assert.equal(await get(port, "/viewer.js"), 200);
        assert.equal(await get(port, "/", { Host: "example.org" }), 403);
        for (const path of ["/../CMakeLists.txt", "/%2e%2e/secret", "/..%2f..%2fetc/passwd", "//etc/passwd", "/.hidden",
            "/recording"])
            assert.equal(await get(port, path), 404, path);
        assert.equal(await end(), 0);
    },

    async "native: clients that vanish, say nonsense, too much or nothing leave others alone"({ program, folder }) {
        const { port, end } = await startNative(program, folder, "stack:3");
        const own = { Origin: `http://localhost:${port}` };
        const enter = async () => (await upgrade(port, own)).socket;
        const answers = async (socket) => {
            socket.write(frame(JSON.stringify({ id: 5, open: "", steps: 2, want: ["poses"] })));
            const bytes = await new Promise((done) => socket.once("data", done));
            assert.equal(bytes[0], 0x82); // a whole binary message
        };
        const first = await enter();
        await answers(first);
        // Half a message, then nothing more; a connection cut in the middle of an answer that nobody reads.
        const half = await enter();
        half.write(frame(JSON.stringify({ open: "box_pile:2000", want: ["poses"] })).subarray(0, 20));
        const deaf = await enter();
        deaf.pause();
        deaf.write(frame(JSON.stringify({ open: "box_pile:4000" })));
        for (let i = 0; i < 200; ++i) deaf.write(frame(JSON.stringify({ steps: 0, want: ["poses", "shapes"] })));
        await answers(first);
        half.destroy();
        deaf.destroy();
        // Beyond the bound: closed. Bytes of no protocol: closed or refused. No JSON: answered.
        const loud = await enter();
        loud.write(frame("x".repeat(70000)));
        await closed(loud);
        const raw = connect(port, "127.0.0.1");
        raw.write("\x00\x01\x02 no protocol\r\n\r\n");
        await closed(raw);
        const odd = await enter();
        odd.write(frame("[1, 2"));
        assert.equal((await new Promise((done) => odd.once("data", done)))[0], 0x82);
        await answers(first);
        first.destroy();
        assert.equal(await end(), 0);
    },

    async "native: without a visitor it gives up with code 0"({ program, folder }) {
        const { ended, output } = await startNative(program, folder, "stack:3", "--give-up", "1");
        assert.equal(await ended, 0);
        assert.match(output(), /ends after 1 s/);
    },
};
