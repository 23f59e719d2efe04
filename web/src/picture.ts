// All that is seen of a world: its bodies, what is drawn over them, and the camera's way. The app says what is shown
// and in which colours; a frame draws what has changed.
import * as THREE from "three";
import { BodyType, poseStride } from "./engine/types";
import { Follow } from "./follow";
import { Futures } from "./futures";
import type { Player } from "./player";
import { shownAs } from "./scenes";
import type { Inspector } from "./ui/inspector";
import { Bodies } from "./view/bodies";
import { Links } from "./view/links";
import { ContactMarks, GripLine } from "./view/marks";
import type { Stage } from "./view/stage";
import { type BoxView, boxViews, drawings, Structure } from "./view/structure";
import { type Colouring, light, type Theme } from "./view/theme";
import { Visuals } from "./view/visuals";

export class Picture {
    readonly bodies: Bodies;
    readonly structure = new Structure();
    readonly grip = new GripLine();
    visuals: Visuals | null = null;
    colours: Colouring = "body";
    contacts = false;
    theme: Theme = light;
    dirty = true; // everything must be placed and painted anew
    private readonly futures: Futures;
    private readonly follow: Follow;
    private readonly links = new Links();
    private readonly marks = new ContactMarks();
    private drawnStep = -1; // state that was drawn last
    private drawnShare = 0;

    constructor(readonly stage: Stage, private readonly player: Player, private readonly inspector: Inspector) {
        this.bodies = new Bodies(stage.drawer.groundMaterial);
        this.futures = new Futures(player, stage);
        this.follow = new Follow(stage);
        const { bodies, marks, structure, links, grip } = this;
        stage.scene.add(bodies.group, marks.group, structure.group, links.group, grip.line);
    }
    private get shown() {
        return shownAs(this.player.sceneName.split(":")[0]);
    }

    // After bodies came or went, or all are those of another scene.
    rebuild(otherScene: boolean): void {
        const shapes = this.player.world.shapes();
        if (otherScene) {
            this.follow.set(shapes, this.shown.follow);
            this.links.forget();
            this.structure.forget();
        }
        this.bodies.build(shapes, otherScene);
        this.futures.rebuild(otherScene, () => this.bodies.measure(this.player.now));
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
    setTheme(theme: Theme): void {
        this.theme = theme;
        this.stage.apply(theme);
        this.dirty = true;
    }
    // At a box, by its two corners, or at what moves.
    lookAtAll(box?: number[]): void {
        this.stage.frame(box ? new THREE.Box3().setFromArray(box) : this.bodies.measure(this.player.picture.now));
        this.dirty = true;
    }
    // Where the page shows the middle of what moves.
    get middle(): [number, number] {
        return this.stage.project(this.bodies.measure(this.player.now).getCenter(new THREE.Vector3()).toArray());
    }

    // The engine's structures that are drawn, by name.
    get drawn(): string[] {
        const boxes: BoxView[] = this.structure.boxes === "none" ? [] : [this.structure.boxes];
        return [...boxes, ...drawings.filter((what) => this.structure[what])];
    }
    set drawn(names: string[]) {
        for (const what of drawings) this.structure[what] = names.includes(what);
        this.structure.boxes = boxViews.find((view) => names.includes(view)) ?? "none";
        if (!this.structure.trails) this.structure.forget();
        this.dirty = true;
    }
    // What the scene shows of itself where nobody has chosen.
    get usual(): string[] {
        return this.shown.draw ?? [];
    }

    // Called once a frame. `pulled`: the line of the grip may have changed.
    draw(pulled: boolean, grip: () => void): void {
        const { world, moment } = this.player, { before, now, share } = this.player.picture;
        const step = moment ? -2 - moment.step : world.stepCount;
        // Lists of a stream come a little later than what they are drawn with.
        const late = world.kind === "native" && (this.structure.any || this.contacts || this.colours === "island");
        const fresh = this.dirty || step !== this.drawnStep || late;
        this.follow.go(before, now, share);
        const moved = this.stage.update();
        // What stands still is not drawn again.
        if (!fresh && !moved && share === this.drawnShare && !pulled) return;
        this.drawnShare = share;
        this.bodies.place(before, now, share, this.dirty);
        this.visuals?.place(this.bodies, before, now, share);
        this.futures.draw(this.dirty);
        this.links.group.visible = this.shown.links === true && !moment;
        if (this.links.group.visible) this.drawLinks();
        if (fresh) this.drawFresh(now, moment !== null);
        this.drawnStep = step;
        this.dirty = false;
        grip();
        this.stage.render();
    }
    private drawLinks(): void {
        const { before, now, share } = this.player.picture, { bodies } = this;
        this.links.place(this.player.world.joints(), (body, out) => {
            if (bodies.typeOf(body) !== BodyType.dynamic || poseStride * body >= now.length) return false;
            out.setFromMatrixPosition(bodies.pose(before, now, body, share));
            return true;
        }, this.stage.span / 220);
    }
    private drawFresh(now: Float32Array, past: boolean): void {
        const { world } = this.player, grouped = this.colours === "island" || this.colours === "colour";
        if (this.dirty || this.colours !== "body") {
            const groups = grouped && !past ? world.groups() : new Int32Array();
            this.bodies.paint(this.colours, now, groups, this.inspector.body ?? -1, this.theme.ground);
            this.futures.paint(this.theme.ground);
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
}
