// Materials: bodies in plain colours, static bodies with a grid of metres on what faces up.
import * as THREE from "three";

export const gridColour = { value: new THREE.Color(0x888888) };
export const groundColour = { value: new THREE.Color(0xcccccc) };
export const groundReach = { value: 10 }; // radius of what is looked at, m

export function bodyMaterial(): THREE.MeshStandardMaterial {
    return new THREE.MeshStandardMaterial({ roughness: 0.62, metalness: 0.02 });
}

// Straight walls, of which several stand behind each other.
export function wallMaterial(): THREE.MeshStandardMaterial {
    return new THREE.MeshStandardMaterial({
        roughness: 0.6, metalness: 0, transparent: true, opacity: 0.07, depthWrite: false,
    });
}

export function glassMaterial(): THREE.MeshStandardMaterial {
    return new THREE.MeshStandardMaterial({
        roughness: 0.3, metalness: 0, transparent: true, opacity: 0.13, depthWrite: false, side: THREE.DoubleSide,
    });
}

// Lines every metre and every ten metres, in world coordinates, as wide as a pixel wherever they are seen; they fade
// before they would flicker.
const gridCode = `
    vec2 gridAt = worldPlace.xz;
    vec2 gridPixel = max(fwidth(gridAt), vec2(1e-6));
    float gridTen = 0.0;
    float gridOne = 0.0;
    {
        vec2 toLine = abs(fract(gridAt - 0.5) - 0.5) / gridPixel;
        float seen = clamp(1.2 - 6.0 * max(gridPixel.x, gridPixel.y), 0.0, 1.0);
        gridOne = seen * (1.0 - min(min(toLine.x, toLine.y), 1.0));
        vec2 tenPixel = gridPixel / 10.0;
        vec2 toTen = abs(fract(gridAt / 10.0 - 0.5) - 0.5) / tenPixel;
        float tenSeen = clamp(1.2 - 6.0 * max(tenPixel.x, tenPixel.y), 0.0, 1.0);
        gridTen = tenSeen * (1.0 - min(min(toTen.x, toTen.y) / 1.3, 1.0));
    }
    float gridUp = smoothstep(0.9, 0.99, worldUp);
    diffuseColor.rgb = mix(diffuseColor.rgb, gridColour, gridUp * max(0.55 * gridOne, gridTen));
`;

// A slab that is much larger than what is looked at ends nowhere: it fades into the sky towards its edges.
const fadeCode = `
    #ifdef USE_FOG
        float groundEdge = max(abs(slabPlace.x), abs(slabPlace.y));
        gl_FragColor.rgb = mix(gl_FragColor.rgb, fogColor, smoothstep(0.3, 0.97, groundEdge));
    #endif
`;
const edgeCode = `
    vec2 slab = vec2(length(instanceMatrix[0].xyz), length(instanceMatrix[2].xyz));
    slabPlace = min(slab.x, slab.y) > 1.6 * groundReach ? position.xz : vec2(0.0);
`;

export function groundMaterial(): THREE.MeshStandardMaterial {
    const material = new THREE.MeshStandardMaterial({ roughness: 0.95, metalness: 0, side: THREE.DoubleSide });
    material.onBeforeCompile = (shader) => {
        shader.uniforms.gridColour = gridColour;
        shader.uniforms.groundReach = groundReach;
        shader.vertexShader = shader.vertexShader
            .replace("#include <common>", `#include <common>
                varying vec3 worldPlace;
                varying float worldUp;
                varying vec2 slabPlace;
                uniform float groundReach;`)
            .replace(
                "#include <project_vertex>",
                `#include <project_vertex>
                worldPlace = (modelMatrix * instanceMatrix * vec4(transformed, 1.0)).xyz;
                worldUp = normalize(mat3(instanceMatrix) * objectNormal).y;
                ${edgeCode}`,
            );
        shader.fragmentShader = shader.fragmentShader
            .replace(
                "#include <common>",
                `#include <common>
                uniform vec3 gridColour;
                varying vec3 worldPlace;
                varying float worldUp;
                varying vec2 slabPlace;`,
            )
            .replace("#include <fog_fragment>", `#include <fog_fragment>\n${fadeCode}`)
            .replace("#include <color_fragment>", `#include <color_fragment>\n${gridCode}`);
    };
    return material;
}
