// The structures of lendulet_c.h, from memory of the module or from the bytes of a stream. All little endian, as every
// machine is that runs a browser.
import type { BodyState, Collider, JointInfo, Settings, Statistics, Vec3 } from "./types";

export const bytesOf = { collider: 68, joint: 120, settings: 64, statistics: 168, body: 172 };

export function vectorAt(buffer: ArrayBuffer, at: number): Vec3 {
    const f = new Float32Array(buffer, at, 3);
    return [f[0], f[1], f[2]];
}

export function collidersAt(buffer: ArrayBuffer, at: number, count: number): Collider[] {
    const list: Collider[] = [];
    for (let i = 0; i < count; ++i, at += bytesOf.collider) {
        const n = new Int32Array(buffer, at, 17), f = new Float32Array(buffer, at, 17);
        list.push({
            body: n[0], type: n[1], mesh: n[2], trigger: n[3] !== 0,
            size: [f[4], f[5], f[6], f[7]], rounding: f[8],
            position: [f[9], f[10], f[11]], orientation: [f[12], f[13], f[14], f[15]], bodyType: n[16],
        });
    }
    return list;
}

export function jointsAt(buffer: ArrayBuffer, at: number, count: number): JointInfo[] {
    const list: JointInfo[] = [];
    for (let i = 0; i < count; ++i, at += bytesOf.joint) {
        const n = new Int32Array(buffer, at, 3), f = new Float32Array(buffer, at, 30);
        const three = (k: number): Vec3 => [f[k], f[k + 1], f[k + 2]];
        list.push({
            bodyA: n[0], bodyB: n[1], type: n[2],
            position: three(3), orientation: Array.from(f.subarray(6, 10)),
            positionB: three(10), orientationB: Array.from(f.subarray(13, 17)),
            value: f[17], velocity: f[18], limit: [f[19], f[20]], swing: f[21], twist: [f[22], f[23]],
            force: three(24), torque: three(27),
        });
    }
    return list;
}

export function settingsAt(buffer: ArrayBuffer, at: number): Settings {
    const n = new Int32Array(buffer, at, 16), f = new Float32Array(buffer, at, 16);
    return {
        gravity: [f[0], f[1], f[2]], stepSize: f[3], solverSteps: n[4], broadPhase: n[5], simplex: n[6],
        integrator: n[7], workers: n[8], width: n[9], sleep: n[10], continuous: n[11], friction: f[12],
        restitution: f[13], rigidSpeed: f[14], staticSpeed: f[15],
    };
}
export function putSettings(s: Settings, buffer: ArrayBuffer, at: number): void {
    const n = new Int32Array(buffer, at, 16), f = new Float32Array(buffer, at, 16);
    f.set([...s.gravity, s.stepSize]);
    n.set([s.solverSteps, s.broadPhase, s.simplex, s.integrator, s.workers, s.width, s.sleep, s.continuous], 4);
    f.set([s.friction, s.restitution, s.rigidSpeed, s.staticSpeed], 12);
}

export function bodyAt(buffer: ArrayBuffer, at: number): BodyState {
    const view = new DataView(buffer, at, bytesOf.body), name = new Uint8Array(buffer, at + 108, 64);
    return {
        position: vectorAt(buffer, at), centreOfMass: vectorAt(buffer, at + 28),
        velocity: vectorAt(buffer, at + 40), angularVelocity: vectorAt(buffer, at + 52),
        momentum: vectorAt(buffer, at + 64), angularMomentum: vectorAt(buffer, at + 76),
        mass: view.getFloat32(88, true), kineticEnergy: view.getFloat32(92, true),
        potentialEnergy: view.getFloat32(96, true), type: view.getInt32(100, true),
        asleep: view.getInt32(104, true) !== 0, name: new TextDecoder().decode(name.slice(0, name.indexOf(0))),
    };
}

export function statisticsAt(buffer: ArrayBuffer, at: number): Statistics {
    const d = new Float64Array(buffer, at, 17), n = new Int32Array(buffer, at + 136, 8);
    return {
        stages: Array.from(d.subarray(0, 8)), total: d[8], kineticEnergy: d[9], potentialEnergy: d[10],
        momentum: [d[11], d[12], d[13]], angularMomentum: [d[14], d[15], d[16]],
        bodies: n[0], awake: n[1], joints: n[2], pairs: n[3], manifolds: n[4], contacts: n[5], colours: n[6],
        penetration: new Float32Array(buffer, at + 164, 1)[0],
    };
}

export function hashText(hash: bigint): string {
    return BigInt.asUintN(64, hash).toString(16).padStart(16, "0");
}
