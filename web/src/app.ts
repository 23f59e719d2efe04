// The viewer as a whole: one world, its picture, and what can be done with both. The page's controls and the keyboard
// (ui/controls.ts) call its methods.
import { Comparison } from "./comparison";
import { fits, type Script } from "./deeds";
import { EngineStopped } from "./engine/wasi";
import { type Command, Refused, type World } from "./engine/types";
import { Hand } from "./hand";
import { Picture } from "./picture";
import { Player } from "./player";
import { Pointer } from "./pointer";
import { shownAs } from "./scenes";
import type { Sources } from "./sources";
import { CompareCard } from "./ui/compare";
import { element } from "./ui/dom";
import { Figures } from "./ui/figures";
import { showHeading } from "./ui/heading";
import { Inspector } from "./ui/inspector";
import { say } from "./ui/message";
import { type Link, readLink, viewOf, writeLink } from "./ui/permalink";
import { nameWithSize, SceneList } from "./ui/scene-list";
import { showTime } from "./ui/time";
import { Tuning } from "./ui/tuning";
import type { Stage } from "./view/stage";
import { drawings } from "./view/structure";
import { type Colouring, colourings, dark, light, type Theme } from "./view/theme";
import { Visuals } from "./view/visuals";

const firstScene = "domino_spiral:300";

type Make = () => World | Promise<World>;

export class App {
    readonly player: Player;
    readonly picture: Picture;
    readonly pointer: Pointer;
    readonly hand: Hand;
    readonly comparison: Comparison;
    readonly inspector = new Inspector();
    away = false; // something else is shown; time stands
    opened: () => void = () => undefined; // another world is shown
    private readonly figures: Figures;
    private readonly tuning: Tuning;
    private readonly list: SceneList;
    private readonly card: CompareCard;
    private make: Make = () => { throw new Refused("nothing is open"); };
    private lastFrame = performance.now();
    private lastFigures = 0;
    private lastLink = 0;
    private openings = 0;
    private slow = 0; // looks at the rate of frames that were too few, one after the other
    private saidLong = false;
    private stopped = false;

    constructor(readonly sources: Sources, readonly stage: Stage) {
        const guarded = (action: () => void) => this.guarded(action);
        this.player = new Player((other) => this.rebuild(other), say);
        this.picture = new Picture(stage, this.player, this.inspector);
        this.player.stepped = (poses) => this.picture.structure.remember(poses);
        this.pointer = new Pointer(this.picture, this.player, (body) => this.pick(body), guarded);
        this.hand = new Hand(stage, this.player, this.pointer);
        this.comparison = new Comparison(this.player, sources.choices[0], sources.stages.indexOf("broad_phase"));
        this.figures = new Figures(sources.stages, stage.drawer.name);
        this.tuning = new Tuning(sources.choices, (settings) => this.change({ do: "set", ...settings }));
        this.list = new SceneList(sources.scenes, (scene) => this.open(scene));
        this.card = new CompareCard(this);
    }

    start(): void {
        const link = readLink(), { given } = this.sources;
        this.setContacts(link.contacts ?? false);
        if (link.paused) this.player.playing = false;
        if (given && !link.scene) this.openWith(given.name, given.make, link);
        else if (!this.open(link.scene ?? firstScene, link)) this.open(firstScene);
        window.addEventListener("hashchange", ({ newURL }) => {
            const wanted = readLink(new URL(newURL).hash); // the page may have written its own over it since
            const other = wanted.scene !== this.player.sceneName || (wanted.compare ?? false) !== this.comparison.on;
            if (wanted.scene && other) this.open(wanted.scene, wanted);
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
    open(scene: string, link: Link = {}, script: Script = { deeds: link.deeds ?? [] }): boolean {
        return this.openWith(scene, () => this.sources.open(scene), link, script);
    }
    openWith(name: string, make: Make, link: Link = {}, script: Script = { deeds: [] }): boolean {
        try {
            this.take(make, (world) => {
                this.make = make;
                this.show(world, name, link, script);
            });
        } catch (error) {
            if (!(error instanceof Refused)) throw error;
            say(error.message);
            return false;
        }
        return true;
    }
    // A world that is made, at once or later; only the last one that was asked for is wanted.
    private take(make: Make, taken: (world: World) => void): void {
        const opening = ++this.openings, made = make();
        const arrived = (world: World) => (opening === this.openings ? taken(world) : world.destroy());
        if (made instanceof Promise) made.then(arrived, (error: Error) => say(error.message));
        else arrived(made);
    }
    private show(world: World, scene: string, link: Link, script: Script): void {
        const name = scene.split(":")[0], shown = shownAs(name), { picture, stage } = this;
        this.opened();
        this.comparison.stop();
        picture.setVisuals(null);
        this.pointer.forget();
        this.saidLong = false;
        this.player.install(world, scene, script);
        this.pick(null);
        showHeading(scene, this.sources.scenes);
        this.list.mark(name);
        this.tuning.show(world.settings());
        this.offerThreads(world);
        const given = link.colours as Colouring;
        this.setColours(colourings.includes(given) ? given : shown.colours ?? "body");
        this.setDrawn(link.draw ?? picture.usual);
        stage.update(); // the camera's shape before it is placed
        picture.lookAtAll(shown.look);
        if (link.view) stage.look(link.view);
        if (world.looks) void this.dress(world, scene);
        this.compare(link.compare ?? false);
    }
    // Draws what the world's file shows, once it is there.
    private async dress(world: World, name: string): Promise<void> {
        try {
            const visuals = await Visuals.read(world.looks!);
            if (this.player.world === world) this.picture.setVisuals(visuals);
        } catch (error) {
            say(`${name}: what collides is drawn (${(error as Error).message})`);
        }
    }
    private offerThreads({ kind }: World): void {
        this.tuning.offerThreads(kind === "native" || (kind === "page" && this.sources.engine?.threads != null));
    }
    setSize(size: number): void {
        const name = this.player.sceneName.split(":")[0];
        const info = this.sources.scenes.find((s) => s.name === name);
        if (info) this.open(size >= 1 ? `${name}:${Math.round(size)}` : nameWithSize(info));
    }
    private rebuild(otherScene: boolean): void {
        const { twin } = this.player;
        this.picture.rebuild(otherScene);
        element("futures").hidden = twin === null;
        element("fork").setAttribute("aria-pressed", String(twin !== null));
    }

    // --- what is seen

    setTheme(theme: Theme): void {
        document.documentElement.dataset.theme = theme.dark ? "dark" : "light";
        this.picture.setTheme(theme);
    }
    toggleTheme(): void {
        this.setTheme(this.picture.theme.dark ? light : dark);
    }
    setColours(how: Colouring): void {
        this.picture.colours = how;
        element<HTMLSelectElement>("colours").value = how;
        this.picture.dirty = true;
        this.writeLink();
    }
    setContacts(on: boolean): void {
        this.picture.contacts = on;
        element("contacts").setAttribute("aria-pressed", String(on));
        this.picture.dirty = true;
        if (this.player.world) this.writeLink();
    }
    // The engine's structures that are drawn, by name.
    setDrawn(names: string[]): void {
        this.picture.drawn = names;
        element<HTMLSelectElement>("boxes").value = this.picture.structure.boxes;
        for (const what of drawings) element<HTMLInputElement>(`show-${what}`).checked = names.includes(what);
        this.writeLink();
    }
    pick(body: number | null): void {
        this.inspector.pick(body);
        this.inspector.sample(this.player.world);
        this.picture.dirty = true;
    }

    // --- what is done

    change(command: Command): void {
        this.guarded(() => this.player.change(command));
    }
    restart(): void {
        this.pointer.release();
        this.take(this.make, (world) => {
            this.pointer.forget();
            this.player.install(world, this.player.sceneName);
            this.tuning.show(world.settings());
            this.offerThreads(world);
            this.pick(null);
        });
    }
    toggleFork(): void {
        if (this.player.twin) this.player.leaveTwin();
        else this.player.fork();
    }
    // The broad phases beside each other.
    compare(on: boolean): void {
        if (on) this.comparison.start();
        else this.comparison.stop();
        this.card.show();
        this.writeLink();
    }
    // The point of the page that balls and boxes of buttons go to: the picture's middle, which between two futures is
    // that of the one that can be played with.
    get middle(): [number, number] {
        const box = this.stage.canvas.getBoundingClientRect();
        return this.player.twin ? this.picture.middle : [box.left + box.width / 2, box.top + box.height / 2];
    }
    readonly say = say;
    // The engine behind the stream is no more.
    lost(sentence: string): void {
        this.player.playing = false;
        this.comparison.stop();
        this.card.show();
        say(sentence, true);
    }

    // What the engine refuses is said; the page goes on. Where the engine itself has stopped, so does the page.
    guarded(action: () => void): void {
        try {
            if (!this.stopped) action();
        } catch (error) {
            this.player.playing = false;
            if (error instanceof EngineStopped || error instanceof WebAssembly.RuntimeError) {
                this.stopped = true;
                say(`The engine has stopped (${error.message}): load the page again.`, true);
            } else if (error instanceof Refused) {
                say(error.message);
            } else {
                throw error;
            }
        }
    }

    // --- frames

    frame(): void {
        const now = performance.now(), { pointer, player } = this;
        player.advance((now - this.lastFrame) / 1000); // what is more than a tenth of a second is left out
        this.lastFrame = now;
        this.picture.draw(pointer.active, () => pointer.draw());
        this.figures.countFrame();
        if (now - this.lastFigures > 200) this.showFigures(now);
        if (now - this.lastLink > 1000) {
            this.lastLink = now;
            this.writeLink();
        }
    }
    private showFigures(now: number): void {
        const { world } = this.player;
        this.lastFigures = now;
        this.figures.show(this.player);
        this.tuning.show(world.settings());
        if (!this.inspector.show(world)) this.pick(null);
        if (this.comparison.on) this.card.show();
        showTime(this.player);
        this.slow = this.figures.rate > 0 && this.figures.rate < 24 ? this.slow + 1 : 0;
        if (this.slow > 10) this.stage.dropOcclusion();
    }

    private writeLink(): void {
        const { picture, player, stage } = this, deeds = player.allDeeds, { drawn, usual } = picture;
        if (!this.saidLong && !fits(deeds)) {
            this.saidLong = true;
            say("What was done here is too long for the page's address; Files, Repro file keeps it.");
        }
        writeLink({
            scene: player.sceneName, colours: picture.colours, contacts: picture.contacts,
            draw: drawn.join() === usual.join() ? undefined : drawn, compare: this.comparison.on,
            view: viewOf(stage.camera, stage.controls), deeds,
        });
    }
}
