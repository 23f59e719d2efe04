// What stands over the scene: its name, a sentence about it, its size.
import type { SceneInfo } from "../engine/types";
import { titleOf } from "../scenes";
import { element } from "./dom";

// `scene`: name and size, "stack:20", or that of a file.
export function showHeading(scene: string, scenes: SceneInfo[]): void {
    const [name, size] = scene.split(":"), info = scenes.find((s) => s.name === name);
    element("scene-name").textContent = info ? titleOf(name) : scene;
    element("scene-text").textContent = info?.description ?? "";
    element("size-label").hidden = !info?.size;
    element<HTMLInputElement>("size").value = size ?? String(info?.size ?? "");
    document.title = `${element("scene-name").textContent} – Lendület`;
}
