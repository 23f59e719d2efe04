// Repro files: what makes a run again, in the page and by `lendulet run FILE`.
import { type Deed, isDeeds } from "../deeds";
import { Refused } from "../engine/types";

// The scene and what was done in it. The hash tells whether it is the same run.
export interface Repro {
    lendulet: "repro";
    version: 1;
    scene: string;
    steps: number;
    hash: string;
    deeds: Deed[];
    gltf?: string; // the file that the scene is of, in base64
}

export function readRepro(name: string, bytes: Uint8Array): Repro {
    let repro: Partial<Repro> | null;
    try {
        repro = JSON.parse(new TextDecoder().decode(bytes)) as Partial<Repro> | null;
    } catch {
        throw new Refused(`${name} is not JSON.`);
    }
    const { lendulet, version, scene, steps, hash, gltf } = repro ?? {};
    if (lendulet !== "repro" || version !== 1 || typeof scene !== "string" || !Number.isInteger(steps))
        throw new Refused(`${name} is no repro file.`);
    if (typeof hash !== "string" || !isDeeds(repro!.deeds) || !/^[A-Za-z0-9+/=]*$/.test(gltf ?? ""))
        throw new Refused(`${name} is a repro file with something in it that cannot be done.`);
    return repro as Repro;
}
