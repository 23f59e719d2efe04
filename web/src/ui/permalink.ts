// The scene, the view and what was done by hand in the page's address: #scene=box_pile:600&colours=speed&view=…&deeds=…
import type * as THREE from "three";
import { decode, type Deed, encode } from "../deeds";
import type { OrbitControls } from "three/addons/controls/OrbitControls.js";

export interface Link {
    scene?: string;
    colours?: string;
    contacts?: boolean;
    draw?: string[]; // of the engine's own structures
    compare?: boolean; // the broad phases
    paused?: boolean;
    view?: number[]; // camera and target, m
    deeds?: Deed[];  // what was done, where it is short enough
}

export function readLink(hash = location.hash): Link {
    const values = new URLSearchParams(hash.slice(1));
    const view = values.get("view")?.split(",").map(Number);
    return {
        scene: values.get("scene") ?? undefined,
        colours: values.get("colours") ?? undefined,
        contacts: values.get("contacts") === "1",
        draw: values.get("draw")?.split(","),
        compare: values.get("compare") === "1",
        paused: values.get("paused") === "1",
        deeds: decode(values.get("deeds") ?? ""),
        view: view?.length === 6 && view.every(Number.isFinite) ? view : undefined,
    };
}

export function viewOf(camera: THREE.Camera, controls: OrbitControls): number[] {
    return [...camera.position.toArray(), ...controls.target.toArray()].map((v) => Number(v.toPrecision(4)));
}

// Replaces the address without a new entry in the browser's history.
export function writeLink(link: Link): void {
    const parts = [`scene=${link.scene ?? ""}`];
    if (link.colours && link.colours !== "body") parts.push(`colours=${link.colours}`);
    if (link.contacts) parts.push("contacts=1");
    if (link.draw) parts.push(`draw=${link.draw.join(",")}`);
    if (link.compare) parts.push("compare=1");
    if (link.view) parts.push(`view=${link.view.join(",")}`);
    const deeds = encode(link.deeds ?? []);
    if (deeds) parts.push(`deeds=${deeds}`);
    const hash = "#" + parts.join("&");
    if (location.hash !== hash) history.replaceState(null, "", hash);
}
