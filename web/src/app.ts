// The viewer as a whole: one world, its picture, and what can be done with both. The page's controls and the keyboard
// (ui/controls.ts) call its methods.
import * as THREE from "three";
import { type BodyNumber, type Engine, Refused } from "./engine/engine";
import { EngineStopped } from "./engine/wasi";
import { Player } from "./player";
import { Pointer, vector } from "./pointer";
import { titleOf } from "./scenes";
import { element } from "./ui/dom";
import { Figures } from "./ui/figures";
import { Inspector } from "./ui/inspector";
import { type Link, readLink, viewOf, writeLink } from "./ui/permalink";
import { nameWithSize, SceneList } from "./ui/scene-list";
import { Bodies } from "./view/bodies";
import { ContactMarks } from "./view/marks";
import type { Stage } from "./view/stage";
import { type Colouring, colourings, dark, light, type Theme } from "./view/theme";

const firstScene = "mixed_pile:600";
const ballSpeed = 22; // in radii of the scene a second, at most 40 m/s

export class App {
    readonly player: Player;
    readonly pointer: Pointer;
    readonly inspector = new Inspector();
    colours: Colouring = "body";
    contacts = false;
    theme: Theme = light;
    private readonly bodies = new Bodies();
    private readonly marks = new ContactMarks();
    private readonly figures: Figures;
    private readonly list: SceneList;
    private numbers: BigUint64Array = new BigUint64Array(); // of the bodies by index
    private dirty = true;    // everything must be placed and painted anew
    private drawnStep = -1;  // state that was drawn last
    private drawnShare = 0;
    private lastFrame = performance.now();
    private lastFigures = 0;
    private lastLink = 0;

    constructor(private readonly engine: Engine, readonly stage: Stage) {
        this.player = new Player(engine, (other) => this.rebuild(other));
        this.pointer = new Pointer(stage, this.player, (body) => this.pick(body));
        this.figures = new Figures(engine);
        this.list = new SceneList(engine.scenes, (scene) => this.open(scene));
        stage.scene.add(this.bodies.group, this.marks.group);
    }

    start(): void {
        const link = readLink();
        if (colourings.includes(link.colours as Colouring)) this.colours = link.colours as Colouring;
        this.setContacts(link.contacts ?? false);
        if (link.paused) this.player.playing = false;
        if (!this.open(link.scene ?? firstScene, link)) this.open(firstScene);
        window.addEventListener("hashchange", () => {
            const wanted = readLink();
            if (wanted.scene && wanted.scene !== this.player.sceneName) this.open(wanted.scene, wanted);
        });
        const frame = () => {
            if (this.stopped) return;
            requestAnimationFrame(frame);
            this.guarded(() => this.frame());
        };
        requestAnimationFrame(frame);
    }

    // --- scenes

    // False, with a message, where the engine refuses the name.
    open(scene: string, link: Link = {}): boolean {
        try {
            this.pointer.release();
            this.player.open(scene);
        } catch (error) {
            if (!(error instanceof Refused)) throw error;
            this.say(error.message);
            return false;
        }
        this.pick(null);
        const [name, size] = scene.split(":");
        const info = this.engine.scenes.find((s) => s.name === name);
        element("scene-name").textContent = titleOf(name);
        element("scene-text").textContent = info?.description ?? "";
        element("size-label").hidden = !info?.size;
        element<HTMLInputElement>("size").value = size ?? String(info?.size ?? "");
        document.title = `${titleOf(name)} – Lendület`;
        this.list.mark(name);
        this.stage.update(); // the camera's shape before it is placed
        if (link.view) {
            this.lookAtAll();
            this.stage.camera.position.fromArray(link.view);
            this.stage.controls.target.fromArray(link.view, 3);
            this.stage.controls.update();
        } else {
            this.lookAtAll();
        }
        this.writeLink();
        return true;
    }
    setSize(size: number): void {
        const name = this.player.sceneName.split(":")[0];
        const info = this.engine.scenes.find((s) => s.name === name);
        if (info) this.open(size >= 1 ? `${name}:${Math.round(size)}` : nameWithSize(info));
    }
    lookAtAll(): void {
        this.stage.frame(this.bodies.measure(this.player.picture.now));
        this.dirty = true;
    }

    private rebuild(otherScene: boolean): void {
        this.bodies.build(this.player.world, otherScene);
        this.numbers = this.player.world.bodies().slice();
        this.dirty = true;
    }

    // --- what is seen

    setTheme(theme: Theme): void {
        this.theme = theme;
        document.documentElement.dataset.theme = theme.dark ? "dark" : "light";
        this.stage.apply(theme);
        this.dirty = true;
    }
    toggleTheme(): void {
        this.setTheme(this.theme.dark ? light : dark);
    }
    setColours(how: Colouring): void {
        this.colours = how;
        this.dirty = true;
        this.writeLink();
    }
    setContacts(on: boolean): void {
        this.contacts = on;
        this.marks.group.visible = on;
        this.dirty = true;
        if (this.player.world) this.writeLink();
    }
    pick(body: BodyNumber | null): void {
        this.inspector.pick(body);
        if (body !== null) this.inspector.sample(this.player.world);
        this.dirty = true;
    }

    // --- what is done

    restart(): void {
        this.pointer.release();
        this.player.restart();
        this.pick(null);
    }
    // A ball from the camera towards a point of the page.
    shoot(x: number, y: number): void {
        const ray = this.stage.ray(x, y), span = this.stage.span;
        const speed = Math.min(ballSpeed * span, 40), radius = Math.min(Math.max(span / 12, 0.05), 0.9);
        const from = ray.origin.clone().addScaledVector(ray.direction, Math.min(0.35 * span, 3));
        const velocity = ray.direction.clone().multiplyScalar(speed);
        this.player.change((world) => world.addSphere(radius, vector(from), vector(velocity), 600));
        if (!this.player.playing) this.say("The ball is there: press play to see it fly.");
    }
    // A box above what lies under a point of the page.
    drop(x: number, y: number): void {
        const span = this.stage.span, half = Math.min(Math.max(span / 16, 0.05), 0.6);
        const hit = this.player.change(() => this.pointer.hit(x, y));
        const { camera, controls } = this.stage, above = new THREE.Vector3();
        if (hit) above.set(...hit.point);
        else this.stage.ray(x, y).at(camera.position.distanceTo(controls.target), above);
        above.y += 6 * half;
        this.player.change((world) => world.addBox([half, half, half], vector(above), [0, 0, 0], 300));
    }

    say(sentence: string): void {
        const message = element("message");
        message.textContent = sentence;
        message.hidden = false;
        clearTimeout(this.quiet);
        this.quiet = window.setTimeout(() => (message.hidden = true), 5000);
    }
    private quiet = 0;

    // What the engine refuses is said; the page goes on. Where the engine itself has stopped, so does the page.
    guarded(action: () => void): void {
        try {
            if (!this.stopped) action();
        } catch (error) {
            this.player.playing = false;
            if (error instanceof EngineStopped || error instanceof WebAssembly.RuntimeError) {
                this.stopped = true;
                this.say(`The engine has stopped (${error.message}): load the page again.`);
                clearTimeout(this.quiet);
            } else if (error instanceof Refused) {
                this.say(error.message);
            } else {
                throw error;
            }
        }
    }
    private stopped = false;

    // --- frames

    private frame(): void {
        const now = performance.now();
        this.player.advance((now - this.lastFrame) / 1000);
        this.lastFrame = now;
        this.draw();
        this.figures.countFrame();
        if (now - this.lastFigures > 200) {
            this.lastFigures = now;
            this.figures.show(this.player);
            if (!this.inspector.show(this.player.world)) this.pick(null);
            this.showTime();
        }
        if (now - this.lastLink > 1000) {
            this.lastLink = now;
            this.writeLink();
        }
    }

    private draw(): void {
        const { before, now, share } = this.player.picture;
        const moment = this.player.moment, step = moment ? -2 - moment.step : this.player.world.stepCount;
        const fresh = this.dirty || step !== this.drawnStep;
        const moved = this.stage.update();
        // What stands still is not drawn again.
        if (!fresh && !moved && share === this.drawnShare && !this.pointer.active) return;
        this.drawnShare = share;
        this.bodies.place(before, now, share, this.dirty);
        if (fresh) {
            if (this.dirty || this.colours !== "body")
                this.bodies.paint(this.colours, now, this.selected(), this.theme.ground);
            this.stage.light(this.bodies.measure(now));
            this.marks.group.visible = this.contacts && !moment;
            if (this.marks.group.visible) this.marks.show(this.player.world.contacts(), this.stage.span);
            if (!moment) this.inspector.sample(this.player.world);
        }
        this.drawnStep = step;
        this.dirty = false;
        this.pointer.draw();
        this.stage.render();
    }
    private selected(): number {
        return this.inspector.body === null ? -1 : this.numbers.indexOf(this.inspector.body);
    }

    private showTime(): void {
        const { history, moment } = this.player;
        const timeline = element<HTMLInputElement>("timeline");
        const last = Math.max(history.moments.length - 1, 0);
        timeline.max = String(last);
        if (!moment) timeline.value = String(last);
        const time = moment ? moment.time : this.player.world.time;
        element("clock").textContent = `${time.toFixed(2)} s`;
        timeline.setAttribute("aria-valuetext", `${time.toFixed(2)} seconds`);
        element("transport").toggleAttribute("data-playing", this.player.playing);
        element("play").setAttribute("aria-label", this.player.playing ? "Pause (space)" : "Play (space)");
    }

    private writeLink(): void {
        writeLink({
            scene: this.player.sceneName, colours: this.colours, contacts: this.contacts,
            view: viewOf(this.stage.camera, this.stage.controls),
        });
    }
}
