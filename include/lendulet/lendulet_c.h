/* Lendület from C, and from everything that can call C: the boundary of the WebAssembly module is this header.
 *
 * A world is a handle. Bodies are numbers that stay valid until the body is removed and are never used again; 0 is
 * none. Whatever can be refused returns a lendulet_result: 0 or more is success, a negative number the kind of error,
 * and lendulet_error() gives the sentence that goes with it. On an error nothing has changed. A null world, and a null
 * pointer where there must be memory, are refused as well.
 *
 * read functions return how many elements there are and set a pointer to them. The memory belongs to the world and
 * holds until the next call with the same world: nothing is copied twice, and nothing has to be freed.
 *
 * Units are SI, angles are in radians, the world is right-handed, quaternions are x y z w. One world must not be used
 * by two threads at the same time.
 *
 * This is the beginning of the C interface: built-in scenes, stepping, reading, picking and a few ways to interfere. */
#ifndef LENDULET_C_H
#define LENDULET_C_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Number of this interface; changes where a call or a structure does. */
#define LENDULET_C_VERSION 1
uint32_t lendulet_version(void);

typedef struct lendulet_world lendulet_world;
typedef uint64_t lendulet_body;

/* >= 0: success; < 0: an error, -1 - lendulet::ErrorCode. */
typedef int32_t lendulet_result;
/* What the last refused call of this thread was refused for: one sentence, empty where none was. */
const char* lendulet_error(void);

/* --- built-in scenes ---------------------------------------------------------------------------------------------- */

int32_t lendulet_scene_count(void);
/* Name without size, one sentence, and the default size (0: the scene has none); null or 0 beyond the last scene. */
const char* lendulet_scene_name(int32_t scene);
const char* lendulet_scene_description(int32_t scene);
int32_t lendulet_scene_size(int32_t scene);

/* --- worlds ------------------------------------------------------------------------------------------------------- */

/* The built-in scene NAME or NAME:SIZE, at its start; null on an error. */
lendulet_world* lendulet_create_scene(const char* name);
/* An empty world with gravity along -y, m/s^2; null on an error. */
lendulet_world* lendulet_create_world(float gravity);
/* Ends a world; null is allowed. */
void lendulet_destroy(lendulet_world* world);

/* One step of lendulet_step_size() seconds, with what the scene does before it and with the pull of lendulet_grab(). */
lendulet_result lendulet_step(lendulet_world* world);
/* The step a scene is meant for, s; 1/60 s where nothing else is said. */
float lendulet_step_size(const lendulet_world* world);
double lendulet_time(const lendulet_world* world);         /* s simulated */
uint64_t lendulet_step_count(const lendulet_world* world); /* steps done */
/* Hash of the state: the same for every machine, compiler and number of threads, native and in WebAssembly. */
uint64_t lendulet_hash(const lendulet_world* world);
/* m/s^2 */
lendulet_result lendulet_set_gravity(lendulet_world* world, const float gravity[3]);
lendulet_result lendulet_read_gravity(const lendulet_world* world, float out[3]);

/* --- bodies ------------------------------------------------------------------------------------------------------- */

typedef struct lendulet_pose {
    float position[3];
    float speed;          /* of its fastest material point, at most, m/s; -1: asleep; 0: static */
    float orientation[4]; /* x y z w */
} lendulet_pose;

/* All bodies in creation order, and their numbers in the same order. */
lendulet_result lendulet_read_poses(lendulet_world* world, const lendulet_pose** out);
lendulet_result lendulet_read_bodies(lendulet_world* world, const lendulet_body** out);

enum { LENDULET_FIXED = 0, LENDULET_KINEMATIC = 1, LENDULET_DYNAMIC = 2 };

typedef struct lendulet_body_state {
    float position[3], orientation[4];
    float centre_of_mass[3];                /* world, m */
    float velocity[3], angular_velocity[3]; /* m/s, rad/s */
    float momentum[3], angular_momentum[3]; /* kg m/s; kg m^2/s about the centre of mass */
    float mass;                             /* kg; infinite where nothing can push it */
    float kinetic_energy, potential_energy; /* J; against gravity from the origin */
    int32_t type;                           /* LENDULET_FIXED ... */
    int32_t asleep;                         /* 0 or 1 */
    char name[64];                          /* ends with a zero; cut where it is longer */
} lendulet_body_state;

lendulet_result lendulet_read_body(const lendulet_world* world, lendulet_body body, lendulet_body_state* out);

/* A body that moves. Half extents and radius in m, density in kg/m^3. `out` may be null. */
lendulet_result lendulet_add_box(lendulet_world* world, const float half_extents[3], const float position[3],
                                 const float velocity[3], float density, lendulet_body* out);
lendulet_result lendulet_add_sphere(lendulet_world* world, float radius, const float position[3],
                                    const float velocity[3], float density, lendulet_body* out);
/* A box that does not move. */
lendulet_result lendulet_add_fixed_box(lendulet_world* world, const float half_extents[3], const float position[3],
                                       lendulet_body* out);
lendulet_result lendulet_remove_body(lendulet_world* world, lendulet_body body);
lendulet_result lendulet_set_velocity(lendulet_world* world, lendulet_body body, const float velocity[3]);
/* N s at a point of the world. */
lendulet_result lendulet_apply_impulse(lendulet_world* world, lendulet_body body, const float impulse[3],
                                       const float point[3]);

/* --- shapes: read once, and again when bodies came or went ---------------------------------------------------------
 */

enum {
    LENDULET_SPHERE = 0,           /* size: radius */
    LENDULET_CAPSULE = 1,          /* half height, radius */
    LENDULET_TAPERED_CAPSULE = 2,  /* half height, bottom radius, top radius */
    LENDULET_BOX = 3,              /* half extents */
    LENDULET_CYLINDER = 4,         /* half height, radius */
    LENDULET_TAPERED_CYLINDER = 5, /* half height, bottom radius, top radius */
    LENDULET_CONE = 6,             /* half height, radius */
    LENDULET_HULL = 7,             /* see `mesh` */
    LENDULET_PLANE = 8,            /* normal, offset: solid where dot(normal, p) <= offset */
    LENDULET_MESH = 9,             /* see `mesh` */
    LENDULET_HEIGHT_FIELD = 10     /* see `mesh`: its triangles */
};

/* A shape on a body. */
typedef struct lendulet_collider {
    int32_t body;                      /* index into the lists of bodies and poses */
    int32_t type;                      /* LENDULET_SPHERE ... */
    int32_t mesh;                      /* for lendulet_read_mesh(); -1: none */
    int32_t trigger;                   /* 1: reports overlaps only */
    float size[4];                     /* see the types above */
    float rounding;                    /* radius of the sphere swept around it */
    float position[3], orientation[4]; /* on the body */
} lendulet_collider;

lendulet_result lendulet_read_colliders(lendulet_world* world, const lendulet_collider** out);

/* Surface of a hull, a mesh or a height field, shared by all colliders that have it. */
typedef struct lendulet_mesh {
    const float* vertices;   /* 3 a vertex */
    const uint32_t* indices; /* 3 a triangle, counter-clockwise from outside */
    int32_t vertex_count, triangle_count;
} lendulet_mesh;

/* After lendulet_read_colliders(). */
lendulet_result lendulet_read_mesh(lendulet_world* world, int32_t mesh, lendulet_mesh* out);

/* --- figures -------------------------------------------------------------------------------------------------------
 */

enum { LENDULET_STAGES = 8 };
/* bounds, broad-phase, ...; null beyond the last. */
const char* lendulet_stage_name(int32_t stage);

typedef struct lendulet_statistics {
    double stage_ms[LENDULET_STAGES], total_ms; /* of the last step; 0 where there is no clock */
    double kinetic_energy, potential_energy;    /* J */
    double momentum[3], angular_momentum[3];    /* the whole world's; about its origin */
    int32_t bodies, awake_bodies, joints, pairs, manifolds, contact_points, colours;
    float max_penetration; /* m */
} lendulet_statistics;

lendulet_result lendulet_read_statistics(const lendulet_world* world, lendulet_statistics* out);

typedef struct lendulet_contact {
    float position[3];
    float separation;     /* m, negative: overlap */
    float normal[3];      /* unit, from A to B */
    float normal_impulse; /* of the last substep, N s */
} lendulet_contact;

/* Every contact point of the last step. */
lendulet_result lendulet_read_contacts(lendulet_world* world, const lendulet_contact** out);

/* --- picking and pulling -------------------------------------------------------------------------------------------
 */

typedef struct lendulet_hit {
    lendulet_body body; /* 0: nothing is met */
    float fraction;     /* of the ray */
    float point[3], normal[3];
} lendulet_hit;

/* The first body along origin + t * translation, t from 0 to 1; triggers are not seen. 1: there is one, 0: none. */
lendulet_result lendulet_cast_ray(const lendulet_world* world, const float origin[3], const float translation[3],
                                  lendulet_hit* out);

/* Pulls a point of a dynamic body as by a damped spring: the point of the world at which it is taken rides with the
 * body, and every step pulls it towards the target of lendulet_drag(). One body at a time. */
lendulet_result lendulet_grab(lendulet_world* world, lendulet_body body, const float point[3]);
lendulet_result lendulet_drag(lendulet_world* world, const float target[3]);
/* Lets go; the body flies on with what velocity it has. */
void lendulet_release(lendulet_world* world);
/* Where the grabbed point is now: 1 and `out`, or 0 where nothing is grabbed. */
lendulet_result lendulet_read_grab(const lendulet_world* world, float out[3]);

/* --- snapshots, see World::snapshot() ------------------------------------------------------------------------------
 */

/* Returns the number of bytes. */
lendulet_result lendulet_read_snapshot(lendulet_world* world, const uint8_t** out);
/* Goes back. Bodies added since are removed again; lets go of what is grabbed. */
lendulet_result lendulet_restore(lendulet_world* world, const uint8_t* bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
