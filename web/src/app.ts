// The viewer as a whole: one world, its picture, and what can be done with both. The page's controls and the keyboard
// (ui/controls.ts) call its methods.
import * as THREE from "three";
import { EngineStopped } from "./engine/wasi";
import { type Command, Refused, type World } from "./engine/types";
import { type Deed, Player } from "./player";
import { Pointer, vector } from "./pointer";
import { followedIn, lookIn, titleOf } from "./scenes";
import type { Sources } from "./sources";
import { element } from "./ui/dom";
import { Figures } from "./ui/figures";
import { Inspector } from "./ui/inspector";
import { type Link, readLink, viewOf, writeLink } from "./ui/permalink";
import { nameWithSize, SceneList } from "./ui/scene-list";
import { Tuning } from "./ui/tuning";
import { Bodies } from "./view/bodies";
import { ContactMarks } from "./view/marks";
import type { Stage } from "./view/stage";
import { Structure } from "./view/structure";
import { type Colouring, colourings, dark, light, type Theme } from "./view/theme";
import { Visuals } from "./view/visuals";

const firstScene = "domino_spiral:300";
const besideFarther = 1.7; // times as far away the camera is where two futures stand side by side
const ballSpeed = 22; // in radii of the scene a second, at most 40 m/s

export class App {
    readonly player: Player;
    readonly pointer: Pointer;
    readonly inspector = new Inspector();
    readonly structure = new Structure();
    colours: Colouring = "body";
    contacts = false;
    theme: Theme = light;
    away = false; // something else is shown; time stands
    private readonly bodies = new Bodies();
    private readonly twinBodies = new Bodies();
    private readonly marks = new ContactMarks();
    private readonly figures: Figures;
    private readonly tuning: Tuning;
    private readonly list: SceneList;
    private visuals: Visuals | null = null;
    private make: () => World | Promise<World> = () => { throw new Refused("nothing is open"); };
    private dirty = true;    // everything must be placed and painted anew
    private drawnStep = -1;  // state that was drawn last
    private drawnShare = 0;
    private lastFrame = performance.now();
    private lastFigures = 0;
    private lastLink = 0;
    private openings = 0;
    private followed = -1; // the body that the camera goes along with, or -1
    private followedAt: THREE.Vector3 | null = null;
    private slow = 0; // looks at the rate of frames that were too few, one after the other

    constructor(readonly sources: Sources, readonly stage: Stage) {
        this.player = new Player((other) => this.rebuild(other), (sentence) => this.say(sentence));
        this.player.stepped = (poses) => this.structure.remember(poses);
        this.pointer = new Pointer(stage, this.player, this.bodies, (body) => this.pick(body),
            (action) => this.guarded(action));
        this.figures = new Figures(sources.stages);
        this.tuning = new Tuning(sources.choices, (settings) => this.change({ do: "set", ...settings }));
        this.list = new SceneList(sources.scenes, (scene) => this.open(scene));
        stage.scene.add(this.bodies.group, this.twinBodies.group, this.marks.group, this.structure.group);
        this.twinBodies.group.visible = false;
    }

    start(): void {
        const link = readLink();
        if (colourings.includes(link.colours as Colouring)) this.colours = link.colours as Colouring;
        this.setContacts(link.contacts ?? false);
        if (link.paused) this.player.playing = false;
        const given = this.sources.given;
        if (given && !link.scene) this.openWith(given.name, given.make, link);
        else if (!this.open(link.scene ?? firstScene, link)) this.open(firstScene);
        window.addEventListener("hashchange", () => {
            const wanted = readLink();
            if (wanted.scene && wanted.scene !== this.player.sceneName) this.open(wanted.scene, wanted);
        });
        const frame = () => {
            if (this.stopped) return;
            requestAnimationFrame(frame);
            if (this.player.world && !this.away) this.guarded(() => this.frame());
        };
        requestAnimationFrame(frame);
    }

    // --- scenes

    // False, with a message, where the engine in the page refuses the name.
    open(scene: string, link: Link = {}, toDo: Deed[] = link.deeds ?? []): boolean {
        return this.openWith(scene, () => this.sources.open(scene), link, toDo);
    }
    openWith(name: string, make: () => World | Promise<World>, link: Link = {}, toDo: Deed[] = []): boolean {
        const opening = ++this.openings;
        const taken = (world: World) => {
            if (opening !== this.openings) return world.destroy();
            this.make = make;
            this.show(world, name, link, toDo);
        };
        try {
            const made = make();
            if (made instanceof Promise) made.then(taken, (error: Error) => this.say(error.message));
            else taken(made);
        } catch (error) {
            if (!(error instanceof Refused)) throw error;
            this.say(error.message);
            return false;
        }
        return true;
    }
    opened: () => void = () => undefined; // another world is shown
    private show(world: World, scene: string, link: Link, toDo: Deed[]): void {
        this.opened();
        this.setVisuals(null);
        this.pointer.forget();
        this.player.install(world, scene, toDo);
        this.pick(null);
        const [name, size] = scene.split(":");
        const info = this.sources.scenes.find((s) => s.name === name);
        element("scene-name").textContent = info ? titleOf(name) : scene;
        element("scene-text").textContent = info?.description ?? "";
        element("size-label").hidden = !info?.size;
        element<HTMLInputElement>("size").value = size ?? String(info?.size ?? "");
        document.title = `${element("scene-name").textContent} – Lendület`;
        this.list.mark(name);
        this.tuning.show(world.settings());
        this.stage.update(); // the camera's shape before it is placed
        this.lookAtAll(lookIn(name));
        if (link.view) {
            this.stage.camera.position.fromArray(link.view);
            this.stage.controls.target.fromArray(link.view, 3);
            this.stage.controls.update();
        }
        if (world.looks) void this.dress(world, scene);
        this.writeLink();
    }
    // Draws what the world's file shows, once it is there.
    private async dress(world: World, name: string): Promise<void> {
        try {
            const visuals = await Visuals.read(world.looks!);
            if (this.player.world === world) this.setVisuals(visuals);
        } catch (error) {
            this.say(`${name}: what collides is drawn (${(error as Error).message})`);
        }
    }
    setSize(size: number): void {
        const name = this.player.sceneName.split(":")[0];
        const info = this.sources.scenes.find((s) => s.name === name);
        if (info) this.open(size >= 1 ? `${name}:${Math.round(size)}` : nameWithSize(info));
    }
    // At a box, by its two corners, or at what moves.
    lookAtAll(box?: number[]): void {
        this.stage.frame(box ? new THREE.Box3().setFromArray(box) : this.bodies.measure(this.player.picture.now));
        this.dirty = true;
    }

    private rebuild(otherScene: boolean): void {
        const shapes = this.player.world.shapes();
        if (otherScene) {
            const name = followedIn(this.player.sceneName.split(":")[0]);
            this.followed = -1;
            for (let i = 0; name && i < shapes.bodies; ++i) if (shapes.name(i) === name) this.followed = i;
            this.followedAt = null;
        }
        this.bodies.build(shapes, otherScene);
        if (otherScene) this.structure.forget();
        const { twin } = this.player, { group } = this.twinBodies, was = group.visible;
        if (twin && !was) {
            this.twinBodies.build(shapes, true);
            this.placeTwin();
        }
        group.visible = twin !== null;
        // Both futures are in the picture, and the one that is left again.
        const half = group.position.clone().multiplyScalar(0.5);
        if (twin && !was) this.stage.shift(half, besideFarther);
        if (!twin && was && !otherScene) this.stage.shift(half.negate(), 1 / besideFarther);
        element("futures").hidden = twin === null;
        element("fork").setAttribute("aria-pressed", String(twin !== null));
        this.dirty = true;
    }
    // The other future stands beside this one.
    private placeTwin(): void {
        const box = this.bodies.measure(this.player.now), side = new THREE.Vector3();
        this.stage.camera.getWorldDirection(side).cross(this.stage.camera.up).normalize();
        side.multiplyScalar(1.15 * Math.max(box.max.x - box.min.x, box.max.z - box.min.z));
        this.twinBodies.group.position.copy(side);
        this.twinBodies.group.updateMatrixWorld(true);
    }
    toggleFork(): void {
        if (this.player.twin) this.player.leaveTwin();
        else this.player.fork();
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
    setStructure(change: Partial<Pick<Structure, "boxes" | "joints" | "momenta" | "trails">>): void {
        Object.assign(this.structure, change);
        if (!this.structure.trails) this.structure.forget();
        this.dirty = true;
    }
    // What a file shows, in place of what collides.
    setVisuals(visuals: Visuals | null): void {
        if (this.visuals) this.stage.scene.remove(this.visuals.group);
        this.visuals = visuals;
        this.bodies.hidden = visuals?.parts ?? new Map();
        if (visuals) this.stage.scene.add(visuals.group);
        this.dirty = true;
    }
    pick(body: number | null): void {
        this.inspector.pick(body);
        if (body !== null) this.inspector.sample(this.player.world);
        this.dirty = true;
    }

    // --- what is done

    change(command: Command): void {
        this.guarded(() => this.player.change(command));
    }
    restart(): void {
        this.pointer.release();
        const opening = ++this.openings, made = this.make();
        const taken = (world: World) => {
            if (opening !== this.openings) return world.destroy();
            this.pointer.forget();
            this.player.install(world, this.player.sceneName);
            this.tuning.show(world.settings());
            this.pick(null);
        };
        if (made instanceof Promise) made.then(taken, (error: Error) => this.say(error.message));
        else taken(made);
    }
    // The point of the page that balls and boxes of buttons go to: the picture's middle, which between two futures is
    // that of the one that can be played with.
    get middle(): [number, number] {
        const box = this.stage.canvas.getBoundingClientRect(), centre = new THREE.Vector3();
        if (!this.player.twin) return [box.left + box.width / 2, box.top + box.height / 2];
        return this.stage.project(this.bodies.measure(this.player.now).getCenter(centre).toArray());
    }
    // A ball from the camera towards a point of the page.
    shoot(x: number, y: number): void {
        const ray = this.stage.ray(x, y), span = this.stage.span;
        const speed = Math.min(ballSpeed * span, 40), radius = Math.min(Math.max(span / 12, 0.05), 0.9);
        const from = ray.origin.clone().addScaledVector(ray.direction, Math.min(0.35 * span, 3));
        const velocity = ray.direction.clone().multiplyScalar(speed);
        this.player.change({ do: "sphere", radius, at: vector(from), velocity: vector(velocity), density: 600 });
        if (!this.player.playing) this.say("The ball is there: press play to see it fly.");
    }
    // A box above what lies under a point of the page.
    drop(x: number, y: number): void {
        const span = this.stage.span, half = Math.min(Math.max(span / 16, 0.05), 0.6);
        const { camera, controls } = this.stage, above = new THREE.Vector3();
        this.player.resume();
        const hit = this.pointer.hit(x, y);
        if (hit) above.set(...hit.point);
        else this.stage.ray(x, y).at(camera.position.distanceTo(controls.target), above);
        above.y += 6 * half;
        const at = vector(above);
        this.player.change({ do: "box", half: [half, half, half], at, velocity: [0, 0, 0], density: 300 });
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
        this.player.advance((now - this.lastFrame) / 1000); // what is more than a tenth of a second is left out
        this.lastFrame = now;
        this.draw();
        this.figures.countFrame();
        if (now - this.lastFigures > 200) {
            this.lastFigures = now;
            this.figures.show(this.player);
            this.tuning.follow(this.player.world.settings());
            if (!this.inspector.show(this.player.world)) this.pick(null);
            this.showTime();
            this.slow = this.figures.rate > 0 && this.figures.rate < 24 ? this.slow + 1 : 0;
            if (this.slow > 10) this.stage.dropOcclusion();
        }
        if (now - this.lastLink > 1000) {
            this.lastLink = now;
            this.writeLink();
        }
    }

    private draw(): void {
        const { world, moment, twin } = this.player, { before, now, share } = this.player.picture;
        const step = moment ? -2 - moment.step : world.stepCount;
        // Lists of a stream come a little later than what they are drawn with.
        const late = world.kind === "native" && (this.structure.any || this.contacts || this.colours === "island");
        const fresh = this.dirty || step !== this.drawnStep || late;
        this.follow();
        const moved = this.stage.update();
        // What stands still is not drawn again.
        if (!fresh && !moved && share === this.drawnShare && !this.pointer.active) return;
        this.drawnShare = share;
        this.bodies.place(before, now, share, this.dirty);
        this.visuals?.place(this.bodies, before, now, share);
        if (twin) this.twinBodies.place(this.player.twinNow, this.player.twinNow, 1, this.dirty);
        if (fresh) this.drawFresh(now, moment !== null);
        this.drawnStep = step;
        this.dirty = false;
        this.pointer.draw();
        this.stage.render();
    }
    // The camera goes where the followed body goes, up and down at most half as far.
    private follow(): void {
        const { before, now, share } = this.player.picture, at = 8 * this.followed;
        if (this.followed < 0 || at >= Math.min(before.length, now.length)) return;
        const place = new THREE.Vector3().fromArray(before, at).lerp(new THREE.Vector3().fromArray(now, at), share);
        if (this.followedAt) {
            const way = place.clone().sub(this.followedAt);
            way.y *= 0.5;
            this.stage.camera.position.add(way);
            this.stage.controls.target.add(way);
        }
        this.followedAt = place;
    }
    private drawFresh(now: Float32Array, past: boolean): void {
        const { world, twin } = this.player, grouped = this.colours === "island" || this.colours === "colour";
        if (this.dirty || this.colours !== "body") {
            const groups = grouped && !past ? world.groups() : new Int32Array();
            this.bodies.paint(this.colours, now, groups, this.inspector.body ?? -1, this.theme.ground);
            if (twin) this.twinBodies.paint("body", this.player.twinNow, groups, -1, this.theme.ground);
        }
        this.stage.light(this.bodies.measure(now));
        this.marks.group.visible = this.contacts && !past;
        if (this.marks.group.visible) this.marks.show(world.contacts(), this.stage.span);
        this.structure.group.visible = !past;
        if (!past) {
            this.structure.show(world, this.stage.span);
            this.inspector.sample(world);
        }
    }

    private showTime(): void {
        const { moment, timeline: [last, at] } = this.player;
        const timeline = element<HTMLInputElement>("timeline");
        timeline.max = String(last);
        timeline.value = String(at);
        const time = moment ? moment.time : this.player.world.time;
        element("clock").textContent = `${time.toFixed(2)} s`;
        timeline.setAttribute("aria-valuetext", `${time.toFixed(2)} seconds`);
        element("transport").toggleAttribute("data-playing", this.player.playing);
        element("play").setAttribute("aria-label", this.player.playing ? "Pause (space)" : "Play (space)");
    }

    private writeLink(): void {
        writeLink({
            scene: this.player.sceneName, colours: this.colours, contacts: this.contacts,
            view: viewOf(this.stage.camera, this.stage.controls), deeds: this.player.deeds,
        });
    }
}
