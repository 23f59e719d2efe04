// How the page shows the built-in scenes (scenes.json): in which group, by what title, and in a size for looking at
// rather than for benchmarks. Scenes that are not in the table are shown under "More", in the engine's size.
import table from "./scenes.json";
import type { Drawing } from "./view/structure";
import type { Colouring } from "./view/theme";

interface Shown {
    title?: string;
    size?: number;
    follow?: string; // name of the body that the camera goes along with
    links?: boolean; // joints are drawn as rods
    colours?: Colouring; // that tell most
    draw?: Drawing[]; // of the engine's own structures, what tells most
    look?: number[]; // the box, by its two corners, that is seen first; without: what moves
}

export const groups = table as unknown as { title: string; scenes: Record<string, Shown> }[];

const shown = new Map(groups.flatMap(({ scenes }) => Object.entries(scenes)));

export function titleOf(name: string): string {
    const words = name.replaceAll("_", " ");
    return shown.get(name)?.title ?? words[0].toUpperCase() + words.slice(1);
}
export function sizeOf(name: string, engineSize: number): number {
    return shown.get(name)?.size ?? engineSize;
}
// All that is known of how a scene is shown.
export function shownAs(name: string): Shown {
    return shown.get(name) ?? {};
}
export function isListed(name: string): boolean {
    return shown.has(name);
}
