/* Uses the C interface as a C program does. Each test returns null, or a sentence of what is wrong. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lendulet/lendulet_c.h"

const char* test_scenes(void);
const char* test_run_is_reproducible(const char* scene, int steps, uint64_t* hash);
const char* test_bodies_and_figures(void);
const char* test_shapes(void);
const char* test_picking_and_pulling(void);
const char* test_snapshots(void);
const char* test_building(void);
const char* test_forks_and_settings(void);
const char* test_structures(void);
const char* test_changes_and_events(void);
const char* test_steering(void);
const char* test_refusals(void);

#define TEXT(x) #x
#define LINE(x) TEXT(x)
#define EXPECT(condition) \
    if (!(condition)) return "line " LINE(__LINE__) ": " #condition

static const float at_rest[3] = {0.0f, 0.0f, 0.0f};

static int run(lendulet_world* world, int steps) {
    int i;
    for (i = 0; i < steps; ++i)
        if (lendulet_step(world) < 0) return 0;
    return 1;
}

/* A floor with its top at y = 0. */
static lendulet_world* with_floor(void) {
    const float half[3] = {10.0f, 0.5f, 10.0f}, below[3] = {0.0f, -0.5f, 0.0f};
    lendulet_world* world = lendulet_create_world(9.81f);
    if (world && lendulet_add_fixed_box(world, half, below, NULL) < 0) return NULL;
    return world;
}

const char* test_scenes(void) {
    int i, found = 0;
    EXPECT(lendulet_version() == LENDULET_C_VERSION);
    for (i = 0; i < lendulet_scene_count(); ++i) {
        EXPECT(strlen(lendulet_scene_name(i)) > 0);
        EXPECT(strlen(lendulet_scene_description(i)) > 10);
        if (strcmp(lendulet_scene_name(i), "box_pile") == 0) found = lendulet_scene_size(i);
    }
    EXPECT(found == 1000);
    EXPECT(lendulet_scene_name(i) == NULL && lendulet_scene_name(-1) == NULL);
    EXPECT(strcmp(lendulet_stage_name(0), "bounds") == 0 && lendulet_stage_name(LENDULET_STAGES) == NULL);
    return NULL;
}

const char* test_run_is_reproducible(const char* scene, int steps, uint64_t* hash) {
    lendulet_world* world = lendulet_create_scene(scene);
    EXPECT(world != NULL);
    EXPECT(lendulet_step_size(world) > 0.01f);
    EXPECT(run(world, steps));
    EXPECT(lendulet_step_count(world) == (uint64_t)steps);
    EXPECT(fabs(lendulet_time(world) - steps * (double)lendulet_step_size(world)) < 1e-6);
    *hash = lendulet_hash(world);
    lendulet_destroy(world);
    return NULL;
}

const char* test_bodies_and_figures(void) {
    const float up[3] = {0.0f, 3.0f, 0.0f}, push[3] = {5.0f, 0.0f, 0.0f}, none[3] = {0.0f, 0.0f, 0.0f};
    float gravity[3];
    lendulet_body ball = 0;
    const lendulet_pose* poses;
    const lendulet_body* bodies;
    const lendulet_contact* contacts;
    lendulet_body_state state;
    lendulet_statistics figures;
    int i, points;
    lendulet_world* world = with_floor();
    EXPECT(world != NULL);
    EXPECT(lendulet_add_sphere(world, 0.5f, up, at_rest, 1000.0f, &ball) == 0 && ball != 0);
    EXPECT(lendulet_read_poses(world, &poses) == 2 && lendulet_read_bodies(world, &bodies) == 2);
    EXPECT(bodies[1] == ball && poses[1].position[1] == 3.0f && poses[1].orientation[3] == 1.0f);
    EXPECT(run(world, 1));
    EXPECT(lendulet_read_poses(world, &poses) == 2 && poses[1].speed > 0.1f && poses[0].speed == 0.0f);
    EXPECT(run(world, 60));
    points = lendulet_read_contacts(world, &contacts);
    EXPECT(points == 1 && fabsf(contacts[0].position[1]) < 0.02f && fabsf(fabsf(contacts[0].normal[1]) - 1.0f) < 1e-3f);
    EXPECT(contacts[0].body_a + contacts[0].body_b == 1 && contacts[0].manifold == 0 &&
           contacts[0].normal_impulse > 0.0f);
    EXPECT(lendulet_read_body(world, ball, &state) == 0);
    EXPECT(fabsf(state.mass - 523.6f) < 0.1f && state.type == LENDULET_DYNAMIC && state.name[0] == 0);
    EXPECT(fabsf(state.position[1] - 0.5f) < 0.01f);
    EXPECT(lendulet_apply_impulse(world, ball, push, state.centre_of_mass) == 0);
    EXPECT(lendulet_read_body(world, ball, &state) == 0 && fabsf(state.momentum[0] - 5.0f) < 1e-3f);
    EXPECT(lendulet_set_velocity(world, ball, up) == 0);
    EXPECT(lendulet_read_body(world, ball, &state) == 0 && state.velocity[1] == 3.0f && !state.asleep);
    EXPECT(lendulet_read_statistics(world, &figures) == 0);
    EXPECT(figures.bodies == 2 && figures.contact_points == 1 && figures.total_ms > 0.0);
    EXPECT(fabs(figures.kinetic_energy - 0.5 * 523.6 * 9.0) < 2.0);
    EXPECT(lendulet_set_gravity(world, none) == 0 && lendulet_read_gravity(world, gravity) == 0 && gravity[1] == 0.0f);
    EXPECT(run(world, 60));
    EXPECT(lendulet_read_body(world, ball, &state) == 0 && state.position[1] > 2.5f);
    EXPECT(lendulet_remove_body(world, ball) == 0);
    EXPECT(lendulet_read_body(world, ball, &state) < 0 && strlen(lendulet_error()) > 10);
    EXPECT(lendulet_read_bodies(world, &bodies) == 1);
    EXPECT(lendulet_add_box(world, up, up, at_rest, 1.0f, NULL) < 0); /* a half extent of 0 */
    for (i = 0; i < 3; ++i) gravity[i] = 1.0f;
    EXPECT(lendulet_add_box(world, gravity, up, at_rest, 1.0f, &ball) == 0);
    lendulet_destroy(world);
    return NULL;
}

const char* test_shapes(void) {
    const lendulet_collider* colliders;
    lendulet_mesh mesh;
    int i, k, count, hulls = 0, boxes = 0;
    lendulet_world* world = lendulet_create_scene("mixed_pile:40");
    EXPECT(world != NULL);
    count = lendulet_read_colliders(world, &colliders);
    EXPECT(count >= 45);
    for (i = 0; i < count; ++i) {
        const lendulet_collider c = colliders[i];
        boxes += c.type == LENDULET_BOX && c.size[0] > 0.0f;
        if (c.type != LENDULET_HULL) continue;
        ++hulls;
        EXPECT(lendulet_read_mesh(world, c.mesh, &mesh) == 0);
        EXPECT(mesh.vertex_count >= 4 && mesh.triangle_count == 2 * mesh.vertex_count - 4); /* Euler */
        for (k = 0; k < 3 * mesh.triangle_count; ++k) EXPECT(mesh.indices[k] < (uint32_t)mesh.vertex_count);
    }
    EXPECT(hulls == 10 && boxes >= 10);
    EXPECT(lendulet_read_mesh(world, 1000, &mesh) < 0);
    lendulet_destroy(world);
    world = lendulet_create_scene("mesh_terrain:10");
    EXPECT(world != NULL && lendulet_read_colliders(world, &colliders) == 11);
    for (i = 0; colliders[i].type != LENDULET_MESH; ++i) EXPECT(i < 10);
    EXPECT(lendulet_read_mesh(world, colliders[i].mesh, &mesh) == 0 && mesh.triangle_count == 100352);
    lendulet_destroy(world);
    return NULL;
}

const char* test_picking_and_pulling(void) {
    const float start[3] = {0.0f, 0.5f, 0.0f}, half[3] = {0.5f, 0.5f, 0.5f};
    const float above[3] = {0.2f, 8.0f, 0.1f}, down[3] = {0.0f, -20.0f, 0.0f}, aside[3] = {5.0f, 8.0f, 0.0f};
    const float corner[3] = {0.5f, 1.0f, 0.5f}, target[3] = {2.0f, 4.0f, 0.0f};
    float held[3];
    lendulet_body box = 0;
    lendulet_hit hit;
    lendulet_body_state state;
    int i;
    lendulet_world* world = with_floor();
    EXPECT(world != NULL && lendulet_add_box(world, half, start, at_rest, 100.0f, &box) == 0);
    EXPECT(lendulet_cast_ray(world, above, down, &hit) == 1 && hit.body == box);
    EXPECT(fabsf(hit.point[1] - 1.0f) < 1e-4f && hit.normal[1] > 0.999f && fabsf(hit.fraction - 0.35f) < 1e-4f);
    EXPECT(lendulet_cast_ray(world, aside, down, &hit) == 1 && hit.body != box && hit.body != 0);
    EXPECT(lendulet_grab(world, hit.body, hit.point) < 0); /* the floor */
    EXPECT(lendulet_cast_ray(world, aside, above, &hit) == 0 && hit.body == 0);
    EXPECT(lendulet_cast_ray(world, above, at_rest, &hit) < 0);

    EXPECT(lendulet_read_grab(world, held) == 0 && lendulet_drag(world, target) < 0);
    EXPECT(lendulet_grab(world, box, corner) == 0 && lendulet_drag(world, target) == 0);
    EXPECT(run(world, 240));
    EXPECT(lendulet_read_grab(world, held) == 1);
    for (i = 0; i < 3; ++i) EXPECT(fabsf(held[i] - target[i]) < 0.1f); /* hangs there, a little lower */
    lendulet_release(world);
    EXPECT(lendulet_read_grab(world, held) == 0 && run(world, 240));
    EXPECT(lendulet_read_body(world, box, &state) == 0 && state.position[1] < 0.8f);
    lendulet_destroy(world);
    return NULL;
}

const char* test_snapshots(void) {
    static uint8_t kept[1 << 20];
    const uint8_t* bytes;
    const lendulet_body* bodies;
    lendulet_body gone;
    uint64_t there, later;
    int size;
    const float up[3] = {0.0f, 9.0f, 0.0f};
    lendulet_world* world = lendulet_create_scene("wall_ball:4");
    EXPECT(world != NULL && run(world, 20));
    size = lendulet_read_snapshot(world, &bytes);
    EXPECT(size > 100 && size < (int)sizeof kept);
    memcpy(kept, bytes, (size_t)size);
    there = lendulet_hash(world);
    EXPECT(run(world, 30));
    later = lendulet_hash(world);
    EXPECT(lendulet_add_sphere(world, 0.3f, up, at_rest, 100.0f, NULL) == 0 && run(world, 10));
    EXPECT(lendulet_restore(world, kept, (size_t)size) == 0);
    EXPECT(lendulet_hash(world) == there && lendulet_step_count(world) == 20);
    EXPECT(run(world, 30) && lendulet_hash(world) == later);
    EXPECT(lendulet_read_bodies(world, &bodies) > 5);
    gone = bodies[3];
    EXPECT(lendulet_remove_body(world, gone) == 0 && run(world, 5) && lendulet_remove_body(world, gone) < 0);
    EXPECT(lendulet_restore(world, kept, (size_t)size) == 0 && lendulet_hash(world) == there);
    EXPECT(lendulet_read_bodies(world, &bodies) > 5 && bodies[3] == gone);
    EXPECT(run(world, 30) && lendulet_hash(world) == later);
    EXPECT(lendulet_restore(world, kept, (size_t)size - 1) < 0 && strstr(lendulet_error(), "bytes") != NULL);
    EXPECT(lendulet_hash(world) == later && lendulet_read_bodies(world, &bodies) > 5);
    EXPECT(lendulet_remove_body(world, gone) == 0);
    lendulet_forget_removed(world);
    EXPECT(lendulet_restore(world, kept, (size_t)size) < 0 && strstr(lendulet_error(), "1 bodies") != NULL);
    lendulet_destroy(world);
    return NULL;
}

static lendulet_part part_of(int type, float a, float b, float c) {
    lendulet_part part;
    memset(&part, 0, sizeof part);
    part.type = type;
    part.mesh = -1;
    part.size[0] = a, part.size[1] = b, part.size[2] = c;
    part.orientation[3] = 1.0f;
    part.density = 500.0f;
    part.friction = part.restitution = -1.0f;
    return part;
}
static lendulet_body_definition body_at(int type, float x, float y) {
    lendulet_body_definition body;
    memset(&body, 0, sizeof body);
    body.position[0] = x, body.position[1] = y;
    body.orientation[3] = 1.0f;
    body.gravity_factor = 1.0f;
    body.type = type;
    strcpy(body.name, "built");
    return body;
}

/* A dumb-bell with a hull on a hinge, over a mesh. */
const char* test_building(void) {
    const float corners[12] = {-5, 0, -5, 5, 0, -5, 5, 0, 5, -5, 0, 5};
    const uint32_t triangles[6] = {0, 2, 1, 0, 3, 2};
    const float points[12] = {0, 0, 0, 0.4f, 0, 0, 0, 0.4f, 0, 0, 0, 0.4f};
    lendulet_body ground, frame, bell;
    lendulet_body_state state;
    lendulet_body_definition definition;
    lendulet_part parts[3], part;
    lendulet_joint_definition joint;
    const lendulet_joint_state* joints;
    lendulet_world* world = lendulet_create_world(9.81f);
    int hull, mesh;
    EXPECT(world != NULL);
    hull = lendulet_add_hull(world, points, 4, 0.0f);
    mesh = lendulet_add_mesh(world, corners, 4, triangles, 2);
    EXPECT(hull >= 0 && mesh > hull && lendulet_add_hull(world, points, 3, 0.0f) < 0);
    part = part_of(LENDULET_MESH, 0, 0, 0);
    part.mesh = mesh;
    definition = body_at(LENDULET_FIXED, 0, 0);
    EXPECT(lendulet_add_body(world, &definition, &part, 1, &ground) == 0);
    part.mesh = hull; /* a hull is no mesh */
    EXPECT(lendulet_add_body(world, &definition, &part, 1, NULL) < 0);
    part = part_of(LENDULET_BOX, 0.1f, 0.1f, 0.1f);
    definition = body_at(LENDULET_FIXED, 0, 3);
    EXPECT(lendulet_add_body(world, &definition, &part, 1, &frame) == 0);
    EXPECT(lendulet_add_body(world, &definition, &part, 0, NULL) < 0);
    parts[0] = part_of(LENDULET_SPHERE, 0.2f, 0, 0);
    parts[1] = part_of(LENDULET_CAPSULE, 0.5f, 0.05f, 0);
    parts[2] = part_of(LENDULET_HULL, 0, 0, 0);
    parts[2].mesh = hull;
    parts[2].position[1] = -0.6f;
    definition = body_at(LENDULET_DYNAMIC, 1, 3);
    EXPECT(lendulet_add_body(world, &definition, parts, 3, &bell) == 0);
    EXPECT(lendulet_read_body(world, bell, &state) == 0 && state.mass > 10.0f && strcmp(state.name, "built") == 0);
    memset(&joint, 0, sizeof joint);
    joint.body_a = frame, joint.body_b = bell, joint.type = LENDULET_HINGE;
    joint.orientation_a[1] = joint.orientation_b[1] = -0.70710678f; /* x onto z */
    joint.orientation_a[3] = joint.orientation_b[3] = 0.70710678f;
    joint.position_b[0] = -1.0f;
    joint.limit[0] = 1.0f, joint.limit[1] = -1.0f;
    joint.swing = 4.0f, joint.twist[0] = 1.0f, joint.twist[1] = -1.0f;
    EXPECT(lendulet_add_joint(world, &joint) == 0);
    joint.type = 9;
    EXPECT(lendulet_add_joint(world, &joint) < 0);
    EXPECT(run(world, 120));
    EXPECT(lendulet_read_joints(world, &joints) == 1 && joints[0].type == LENDULET_HINGE);
    EXPECT(joints[0].body_a == 1 && joints[0].body_b == 2 && fabsf(joints[0].position[1] - 3.0f) < 1e-5f);
    EXPECT(fabsf(joints[0].position_b[0]) < 0.01f && fabsf(joints[0].position_b[1] - 3.0f) < 0.01f);
    lendulet_destroy(world);
    return NULL;
}

const char* test_forks_and_settings(void) {
    const float up[3] = {0.0f, 9.0f, 0.0f};
    lendulet_settings settings, read;
    lendulet_world *world = lendulet_create_scene("stack:6"), *fork;
    EXPECT(world != NULL && run(world, 10));
    fork = lendulet_fork(world);
    EXPECT(fork != NULL && lendulet_hash(fork) == lendulet_hash(world));
    EXPECT(run(world, 20) && run(fork, 20) && lendulet_hash(fork) == lendulet_hash(world));
    EXPECT(lendulet_add_sphere(fork, 0.4f, up, at_rest, 300.0f, NULL) == 0);
    EXPECT(run(world, 5) && run(fork, 5) && lendulet_hash(fork) != lendulet_hash(world));
    lendulet_destroy(fork);
    EXPECT(lendulet_fork(NULL) == NULL);

    EXPECT(lendulet_read_settings(world, &settings) == 0 && settings.solver_steps == 8 &&
           settings.gravity[1] == -10.0f);
    settings.solver_steps = 3, settings.gravity[1] = 2.0f, settings.step_size = 0.01f, settings.broad_phase = 1;
    EXPECT(lendulet_set_settings(world, &settings) == 0 && lendulet_read_settings(world, &read) == 0);
    EXPECT(memcmp(&settings, &read, sizeof read) == 0 && lendulet_step_size(world) == 0.01f);
    EXPECT(run(world, 100));
    settings.solver_steps = 100;
    EXPECT(lendulet_set_settings(world, &settings) < 0 && strstr(lendulet_error(), "64") != NULL);
    settings.solver_steps = 4, settings.integrator = 17;
    EXPECT(lendulet_set_settings(world, &settings) < 0);
    settings.integrator = 0, settings.step_size = 0.0f;
    EXPECT(lendulet_set_settings(world, &settings) < 0 && lendulet_step_size(world) == 0.01f);
    EXPECT(strcmp(lendulet_choice_name(LENDULET_BROAD_PHASES, 0), "all-pairs") == 0);
    EXPECT(lendulet_choice_name(LENDULET_INTEGRATORS, 4) == NULL && lendulet_choice_name(7, 0) == NULL);
    lendulet_destroy(world);
    return NULL;
}

const char* test_structures(void) {
    const lendulet_box* boxes;
    const lendulet_group* groups;
    const lendulet_motion* motions;
    int i, count, leaves = 0, nodes = 0, moving = 0, coloured = 0;
    lendulet_world* world = lendulet_create_scene("box_pile:60");
    EXPECT(world != NULL && run(world, 60));
    count = lendulet_read_boxes(world, &boxes);
    for (i = 0; i < count; ++i) {
        leaves += boxes[i].leaf == 1, nodes += boxes[i].leaf == 0;
        EXPECT(boxes[i].lower[0] <= boxes[i].upper[0] && boxes[i].depth >= 0);
    }
    EXPECT(leaves == 65 && nodes > 0);
    EXPECT(lendulet_read_groups(world, &groups) == 65 && groups[0].island == -1);
    for (i = 0; i < 65; ++i) moving += groups[i].island >= 0, coloured += groups[i].colour >= 0;
    EXPECT(moving > 30 && coloured > 30);
    EXPECT(lendulet_read_motions(world, &motions) == 65 && motions[0].mass == 0.0f);
    EXPECT(motions[64].mass > 50.0f && motions[64].momentum[1] != 0.0f && motions[64].reach > 0.5f);
    lendulet_destroy(world);
    return NULL;
}

const char* test_changes_and_events(void) {
    const float up[3] = {0.0f, 1.5f, 0.0f};
    const lendulet_spring servo = {50.0f, 10.0f, 0.4f, 0.0f, 1e3f};
    lendulet_body_definition definition;
    lendulet_joint_definition hinge;
    lendulet_part part;
    lendulet_body ball = 0, post = 0, arm = 0;
    const lendulet_shape* shapes;
    const lendulet_joint* joints;
    const lendulet_joint_state* states;
    const lendulet_touch* touches;
    const lendulet_blow* hits;
    const lendulet_sleep* sleeps;
    const lendulet_break* breaks;
    lendulet_body_state state;
    lendulet_joint joint;
    int i, begins = 0, blows = 0, slept = 0, broken = 0;
    lendulet_world* world = with_floor();
    EXPECT(world != NULL && lendulet_add_sphere(world, 0.5f, up, at_rest, 1000.0f, &ball) == 0);
    EXPECT(lendulet_read_shapes(world, ball, &shapes) == 1 && lendulet_read_shapes(world, 0, &shapes) < 0);
    EXPECT(lendulet_read_shapes(world, ball, &shapes) == 1);
    EXPECT(lendulet_set_events(world, shapes[0], LENDULET_CONTACT_EVENTS + LENDULET_HIT_EVENTS) == 0);
    EXPECT(lendulet_set_events(world, 0, LENDULET_HIT_EVENTS) < 0);
    for (i = 0; i < 90; ++i) {
        EXPECT(run(world, 1));
        if (lendulet_read_touches(world, LENDULET_CONTACT_BEGINS, &touches) == 1) {
            ++begins;
            EXPECT(touches[0].body_b == ball && touches[0].shape_b == shapes[0]);
        }
        if (lendulet_read_hits(world, &hits) == 1) {
            ++blows;
            EXPECT(fabs(hits[0].speed - sqrt(2.0 * 9.81)) < 0.05 && hits[0].normal[1] > 0.99f);
            EXPECT(hits[0].impulse > 2000.0f && hits[0].touch.body_b == ball);
        }
        if (lendulet_read_sleep_events(world, &sleeps) == 1) slept += sleeps[0].body == ball && sleeps[0].asleep == 1;
    }
    EXPECT(begins == 1 && blows == 1 && slept == 1);
    EXPECT(lendulet_read_touches(world, 4, &touches) < 0 && lendulet_read_touches(world, 3, &touches) == 0);
    EXPECT(lendulet_set_filter(world, shapes[0], 1, 0, 0) == 0 && run(world, 1));
    EXPECT(lendulet_read_touches(world, LENDULET_CONTACT_ENDS, &touches) == 1 && touches[0].body_b == ball);
    EXPECT(lendulet_remove_body(world, ball) == 0);

    memset(&definition, 0, sizeof definition), memset(&part, 0, sizeof part), memset(&hinge, 0, sizeof hinge);
    definition.orientation[3] = part.orientation[3] = hinge.orientation_a[3] = hinge.orientation_b[3] = 1.0f;
    definition.gravity_factor = 1.0f;
    definition.position[1] = 5.0f;
    part.type = LENDULET_BOX;
    part.size[0] = part.size[1] = part.size[2] = 0.1f;
    part.density = 1000.0f, part.friction = part.restitution = -1.0f;
    EXPECT(lendulet_add_body(world, &definition, &part, 1, &post) == 0);
    definition.type = LENDULET_DYNAMIC;
    definition.position[1] = 4.0f;
    EXPECT(lendulet_add_body(world, &definition, &part, 1, &arm) == 0);
    hinge.body_a = post, hinge.body_b = arm, hinge.type = LENDULET_HINGE;
    hinge.position_b[1] = 1.0f;
    hinge.limit[0] = 1.0f, hinge.limit[1] = -1.0f;
    hinge.break_force = 20000.0f;
    EXPECT(lendulet_add_joint(world, &hinge) == 0);
    EXPECT(lendulet_read_joint_numbers(world, &joints) == 1);
    joint = joints[0];
    EXPECT(lendulet_set_motor(world, joint, LENDULET_ONLY, 0.5f, 1e4f) == 0);
    EXPECT(lendulet_set_motor(world, joint, LENDULET_ONLY, NAN, 1.0f) < 0);
    EXPECT(lendulet_set_motor(world, joint, 8, 1.0f, 1.0f) < 0 && lendulet_set_motor(world, joint, 0, 1.0f, 1.0f) < 0);
    EXPECT(run(world, 30) && lendulet_read_joints(world, &states) == 1);
    EXPECT(fabs(states[0].velocity - 0.5f) < 0.01f && fabs(states[0].value - 0.25f) < 0.01f);
    EXPECT(lendulet_set_motor(world, joint, LENDULET_ONLY, 0.0f, 0.0f) == 0);
    EXPECT(lendulet_set_spring(world, joint, LENDULET_ONLY, &servo) == 0 &&
           lendulet_set_spring(world, joint, LENDULET_ONLY, NULL) < 0);
    EXPECT(lendulet_set_joint_friction(world, joint, LENDULET_ONLY, 2.0f) == 0);
    EXPECT(lendulet_set_joint_friction(world, joint, LENDULET_ONLY, -2.0f) < 0 &&
           lendulet_set_joint_friction(world, joint, LENDULET_ALONG_X, 2.0f) < 0 &&
           lendulet_set_joint_friction(NULL, joint, LENDULET_ONLY, 2.0f) < 0);
    EXPECT(lendulet_set_joint_friction(world, joint, LENDULET_ONLY, 0.0f) == 0);
    EXPECT(lendulet_set_limit(world, joint, LENDULET_ONLY, -0.1f, 0.1f) == 0);
    EXPECT(lendulet_set_limit(world, joint, LENDULET_ONLY, 0.2f, 0.1f) < 0);
    EXPECT(run(world, 120) && lendulet_read_joints(world, &states) == 1 && states[0].value < 0.12f);

    EXPECT(lendulet_set_body_type(world, arm, LENDULET_KINEMATIC) == 0);
    EXPECT(lendulet_read_body(world, arm, &state) == 0 && state.type == LENDULET_KINEMATIC);
    EXPECT(lendulet_set_body_type(world, arm, LENDULET_FIXED) < 0 && lendulet_set_body_type(world, post, 2) < 0);
    EXPECT(lendulet_set_body_type(world, arm, LENDULET_DYNAMIC) == 0);
    {
        const float down[3] = {0.0f, -1000.0f, 0.0f}, there[3] = {0.0f, 4.0f, 0.0f};
        EXPECT(lendulet_apply_impulse(world, arm, down, there) == 0);
    }
    for (i = 0; i < 10; ++i) {
        EXPECT(run(world, 1));
        if (lendulet_read_joint_breaks(world, &breaks) == 1) {
            ++broken;
            EXPECT(breaks[0].joint == joint && breaks[0].body_b == arm && breaks[0].force[1] > 20000.0f);
        }
    }
    EXPECT(broken == 1 && lendulet_read_joint_numbers(world, &joints) == 0);
    EXPECT(lendulet_set_motor(world, joint, LENDULET_ONLY, 1.0f, 1.0f) < 0);
    EXPECT(lendulet_read_hits(NULL, &hits) < 0 && lendulet_read_sleep_events(world, NULL) < 0);
    lendulet_destroy(world);
    return NULL;
}

/* A ball on a belt that is started, pushed, put elsewhere, and asked for; a crank that is let go. */
const char* test_steering(void) {
    const float up[3] = {0.0f, 0.5f, 0.0f}, away[3] = {5.0f, 0.5f, 0.0f}, turned[4] = {0.0f, 1.0f, 0.0f, 0.0f};
    const float bad[3] = {NAN, 0.0f, 0.0f}, push[3] = {1000.0f, 0.0f, 0.0f}, ahead[3] = {4.5f, 0.0f, 0.0f};
    const float spin[3] = {0.0f, 3.0f, 0.0f}, lift[3] = {0.0f, 1.5f, 0.0f};
    lendulet_material belt = {-1.0f, -1.0f, -1.0f, 0.0f, 0.0f, 0.0f, {0.0f, 0.0f, 3.5f}};
    lendulet_body_definition definition;
    lendulet_joint_definition joint;
    lendulet_part part;
    lendulet_body ball = 0, platform = 0;
    const lendulet_body *bodies, *overlaps;
    const lendulet_shape* shapes;
    const lendulet_joint* joints;
    lendulet_body_state state;
    lendulet_hit hit;
    lendulet_world* world = with_floor();
    EXPECT(world != NULL && lendulet_add_sphere(world, 0.5f, up, at_rest, 1000.0f, &ball) == 0);
    EXPECT(lendulet_read_bodies(world, &bodies) == 2);
    EXPECT(lendulet_read_shapes(world, bodies[0], &shapes) == 1);
    EXPECT(lendulet_set_material(world, shapes[0], &belt) == 0 && lendulet_set_material(world, 0, &belt) < 0);
    EXPECT(lendulet_set_material(world, shapes[0], NULL) < 0);
    EXPECT(run(world, 120) && lendulet_read_body(world, ball, &state) == 0);
    EXPECT(fabsf(state.velocity[2] - 1.0f) < 0.01f); /* 2/7 of the belt's */
    EXPECT(lendulet_set_pose(world, ball, away, turned) == 0 && lendulet_set_pose(world, ball, bad, turned) < 0);
    EXPECT(lendulet_set_angular_velocity(world, ball, spin) == 0 && lendulet_set_velocity(world, ball, at_rest) == 0);
    EXPECT(lendulet_read_body(world, ball, &state) == 0);
    EXPECT(state.position[0] == 5.0f && state.orientation[1] == 1.0f &&
           fabsf(state.angular_velocity[1] - 3.0f) < 1e-5f);
    EXPECT(lendulet_set_mass(world, ball, 2.0f) == 0 && lendulet_set_mass(world, bodies[0], 2.0f) < 0 &&
           lendulet_set_mass(world, ball, 0.0f) < 0);
    EXPECT(lendulet_read_body(world, ball, &state) == 0 && state.mass == 2.0f);
    EXPECT(lendulet_set_mass(world, ball, 500.0f) == 0);
    belt.surface_velocity[2] = 0.0f;
    EXPECT(lendulet_set_material(world, shapes[0], &belt) == 0);
    EXPECT(lendulet_set_gravity_factor(world, ball, 0.0f) == 0 && lendulet_set_damping(world, ball, -1.0f, 0.0f) < 0);
    EXPECT(lendulet_apply_force(world, ball, push, away) == 0 && lendulet_apply_torque(world, ball, push) == 0);
    EXPECT(run(world, 1) && lendulet_read_body(world, ball, &state) == 0);
    EXPECT(fabsf(state.velocity[0] * state.mass - 1000.0f / 60.0f) < 1.0f);
    EXPECT(lendulet_apply_force(world, bodies[0], push, away) < 0 && lendulet_apply_torque(world, 0, push) < 0);

    lendulet_default_part(&part);
    part.position[1] = 0.6f;
    EXPECT(lendulet_cast_shape(world, &part, ahead, &hit) == 1 && hit.body == ball);
    EXPECT(fabsf(hit.fraction - 0.89f) < 0.01f && hit.normal[0] < -0.9f);
    EXPECT(lendulet_cast_shape(world, &part, at_rest, &hit) < 0 && lendulet_cast_shape(world, NULL, ahead, &hit) < 0);
    part.position[1] = 0.4f;
    EXPECT(lendulet_read_overlaps(world, &part, &overlaps) == 1);
    EXPECT(lendulet_read_bodies(world, &bodies) == 2 && overlaps[0] == bodies[0]);
    part.type = LENDULET_HULL;
    EXPECT(lendulet_read_overlaps(world, &part, &overlaps) < 0 && strstr(lendulet_error(), "read_overlaps") != NULL);

    lendulet_default_body(&definition);
    lendulet_default_part(&part);
    definition.type = LENDULET_KINEMATIC;
    definition.position[1] = 1.0f, definition.position[2] = 4.0f;
    EXPECT(lendulet_add_body(world, &definition, &part, 1, &platform) == 0);
    definition.position[1] = 2.0f;
    EXPECT(lendulet_move_to(world, platform, lift, definition.orientation) == 0);
    EXPECT(run(world, 1) && lendulet_read_body(world, platform, &state) == 0);
    EXPECT(fabsf(state.position[1] - 1.5f) < 1e-4f && fabsf(state.position[2]) < 1e-4f);

    lendulet_default_joint(&joint);
    joint.body_a = platform, joint.body_b = ball;
    EXPECT(lendulet_add_joint(world, &joint) == 0 && lendulet_read_joint_numbers(world, &joints) == 1);
    EXPECT(lendulet_remove_joint(world, joints[0]) == 0 && lendulet_read_joint_numbers(world, &joints) == 0);
    EXPECT(lendulet_remove_joint(world, 0) < 0);
    lendulet_default_part(NULL), lendulet_default_body(NULL), lendulet_default_joint(NULL);
    lendulet_destroy(world);
    return NULL;
}

const char* test_refusals(void) {
    const float wrong[3] = {0.0f, NAN, 0.0f};
    const lendulet_pose* poses;
    lendulet_body_state state;
    lendulet_world* world;
    EXPECT(lendulet_create_scene("no_such_scene") == NULL && strstr(lendulet_error(), "no_such_scene") != NULL);
    EXPECT(lendulet_create_scene(NULL) == NULL && lendulet_create_world(NAN) == NULL);
    EXPECT(lendulet_step(NULL) < 0 && lendulet_read_poses(NULL, &poses) < 0 && lendulet_hash(NULL) == 0);
    world = lendulet_create_world(10.0f);
    EXPECT(world != NULL && lendulet_read_poses(world, NULL) < 0 && lendulet_read_poses(world, &poses) == 0);
    EXPECT(lendulet_reserve(world, -1, 0, 0) < 0 && strstr(lendulet_error(), "bodies") != NULL);
    EXPECT(lendulet_reserve(world, 10, 0, 1) == 0 && lendulet_reserve(NULL, 1, 1, 1) < 0);
    EXPECT(lendulet_set_gravity(world, wrong) < 0 && strstr(lendulet_error(), "finite") != NULL);
    EXPECT(lendulet_add_sphere(world, 0.5f, wrong, at_rest, 1.0f, NULL) < 0);
    EXPECT(lendulet_add_sphere(world, -1.0f, at_rest, at_rest, 1.0f, NULL) < 0);
    EXPECT(lendulet_read_body(world, 0, &state) < 0 && lendulet_remove_body(world, 12345) < 0);
    EXPECT(lendulet_set_velocity(world, 0, at_rest) < 0 && lendulet_grab(world, 0, at_rest) < 0);
    lendulet_destroy(world);
    lendulet_destroy(NULL);
    return NULL;
}
